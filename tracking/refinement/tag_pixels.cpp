#include "tracking/refinement/tag_pixels.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/projection.hpp"

namespace catchlight::tracking {
namespace {

/// Farther from an edge, a pixel says nothing about its place; hardly anything beyond the second, where there are plenty.
constexpr double kEdgeReachSigmas = 3, kShortReachSigmas = 2.3;
constexpr double kPlateauShare = 0.125;  ///< share of the plateaus' pixels that gives the levels of white and black
/// Distance to the end of what is known of the print, where the paper may have been cut.
constexpr double kClearanceCells = 0.3, kClearanceSigmas = 2.5;

constexpr double kGolden = 0.6180339887498949;  ///< shifts each row's start, so that no two look at the same columns
constexpr double kCandidates = 5;               ///< pixels looked at for each one wanted; many are on plateaus

double fraction(double x) {
  return x - std::floor(x);
}

/// Evenly spread over the plane without a grid's preference for directions (Roberts' R2 sequence); the same for every frame.
double even_hash(int x, int y) {
  return fraction(0.7548776662466927 * x + 0.5698402909980532 * y);
}

/// A second one, independent of the first (Kronecker's sequence of square roots).
double other_hash(int x, int y) {
  return fraction(0.4142135623730951 * x + 0.7320508075688772 * y);
}

/// Half-open rectangle of pixels around the print as seen.
PixelRect print_region(const CameraModel& camera, const TagPattern& pattern, const TagView& view) {
  constexpr int kPointsPerSide = 4;  // a lens bends the outline
  glm::dvec2 low(1e9), high(-1e9);
  const double first = -pattern.margin(), last = pattern.cells_across() + pattern.margin();
  for (int i = 0; i <= kPointsPerSide; ++i) {
    const double at = first + (last - first) * i / kPointsPerSide;
    for (const glm::dvec2& cell : {glm::dvec2(at, first), {at, last}, {first, at}, {last, at}}) {
      const auto ideal_px = view.ideal_px(cell);
      if (!ideal_px) return {};
      const glm::dvec2 seen = distort_px(camera, *ideal_px);
      if (!std::isfinite(seen.x + seen.y)) return {};
      low = glm::min(low, seen);
      high = glm::max(high, seen);
    }
  }
  const glm::dvec2 image(camera.width_px, camera.height_px);
  const glm::ivec2 from(glm::clamp(glm::floor(low) - 1.0, glm::dvec2(0), image));
  const glm::ivec2 to(glm::clamp(glm::ceil(high) + 2.0, glm::dvec2(0), image));
  return {from.x, from.y, to.x - from.x, to.y - from.y};
}

double block_code(const LumaView& luma, const ResponseTable& response, int x, int y, int block) {
  const std::uint8_t* data = luma.data + static_cast<std::ptrdiff_t>(y) * luma.stride + x;
  if (block == 1) return response.normalised(*data);
  double sum = 0;
  for (int j = 0; j < block; ++j)
    for (int i = 0; i < block; ++i) sum += response.linear(data[static_cast<std::ptrdiff_t>(j) * luma.stride + i]);
  return response.code(sum / (block * block)).value;
}

/// How far around a pixel its light and the pose's error reach, in cells.
struct Reach {
  glm::dvec2 edge;       ///< in which an edge makes the pixel worth looking at
  glm::dvec2 clearance;  ///< that has to be known
};

Reach reach_at(const PlanePoint& point, const PixelChoice& choice, bool has_plenty) {
  const Covariance2 blur = in_cells(choice.blur_px2, point.cell_per_px), slack = in_cells({1, 0, 1}, point.cell_per_px);
  const glm::dvec2 sigma(std::sqrt(blur.xx), std::sqrt(blur.yy));
  const glm::dvec2 slack_cells = choice.slack_px * glm::dvec2(std::sqrt(slack.xx), std::sqrt(slack.yy));
  return {(has_plenty ? kShortReachSigmas : kEdgeReachSigmas) * sigma + slack_cells,
          glm::max(kClearanceSigmas * sigma, glm::dvec2(kClearanceCells)) + slack_cells};
}

bool is_near(const TagPattern& pattern, const glm::dvec2& cell) {
  const double first = -pattern.margin(), last = pattern.cells_across() + pattern.margin();
  return cell.x > first && cell.y > first && cell.x < last && cell.y < last;
}

/// Whether a pixel's light is all of known cells, and worth looking at.
bool is_wanted(const TagPattern& pattern, const glm::dvec2& cell, const Reach& reach, double plateau_hash) {
  const double end = pattern.cells_across() / 2.0 + pattern.margin();
  const glm::dvec2 to_end = end - glm::abs(cell - pattern.cells_across() / 2.0);
  if (glm::any(glm::lessThan(to_end, reach.clearance))) return false;
  switch (pattern.around(cell, reach.edge)) {
    case TagPattern::Neighbourhood::unknown:
      return false;
    case TagPattern::Neighbourhood::plateau:
      return plateau_hash < kPlateauShare;
    case TagPattern::Neighbourhood::edge:
      return true;
  }
  return false;
}

/// Rounded down to a few steps, so that a tag that hardly moves keeps its pixels.
double stepped_share(double share) {
  return share >= 1 ? 1 : std::exp2(std::floor(8 * std::log2(share)) / 8);
}

}  // namespace

std::vector<TagPixel> choose_pixels(const LumaView& luma, const CameraModel& camera, IdealPixels& ideal_pixels,
                                    const ResponseTable& response, const TagPattern& pattern, const TagView& view,
                                    const PixelChoice& choice) {
  const int block = choice.block_px;
  const PixelRect region = print_region(camera, pattern, view);
  const double blocks = static_cast<double>(region.width) * region.height / (block * block);
  const double stride = 1 / stepped_share(kCandidates * static_cast<double>(choice.most) / std::max(blocks, 1.0));
  struct Candidate {
    TagPixel pixel;
    double hash;
  };
  std::vector<Candidate> candidates;
  const auto last_column = (region.x + region.width) / block, last_row = (region.y + region.height) / block;
  for (int row = (region.y + block - 1) / block; row < last_row; ++row) {
    std::optional<Reach> reach;  // hardly changes along a row
    // Counted from the picture's edge, not the tag's.
    const double phase = fraction(kGolden * row), first = std::ceil((region.x + block - 1) / block / stride - phase);
    for (double at = stride * (std::max(first, 0.0) + phase); at < last_column; at += stride) {
      const int column = static_cast<int>(at), x = column * block, y = row * block;
      const double to_center = (block - 1) / 2.0;
      const auto place = block == 1 ? ideal_pixels.at(x, y) : ideal_pixel(camera, {x + to_center, y + to_center});
      const auto cell = place ? view.cell_at(place->ideal_px) : std::nullopt;
      if (!cell || !is_near(pattern, *cell)) continue;
      if (!reach) reach = reach_at(*view.at(place->ideal_px), choice, blocks > 2 * static_cast<double>(choice.most));
      if (is_wanted(pattern, *cell, *reach, even_hash(column, row)))
        candidates.push_back({{*place, block_code(luma, response, x, y, block)}, other_hash(column, row)});
    }
  }
  const double share =
      stepped_share(static_cast<double>(choice.most) / static_cast<double>(std::max<std::size_t>(candidates.size(), 1)));
  std::vector<TagPixel> pixels;
  for (const Candidate& candidate : candidates)
    if (candidate.hash < share) pixels.push_back(candidate.pixel);
  return pixels;
}

}  // namespace catchlight::tracking
