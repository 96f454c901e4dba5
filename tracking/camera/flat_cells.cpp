#include "tracking/camera/flat_cells.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/response.hpp"
#include "tracking/camera/photometry.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/refinement/ideal_pixels.hpp"
#include "tracking/refinement/tag_pattern.hpp"
#include "tracking/refinement/tag_view.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kReachSigmas = 3, kReachPx = 1;  ///< how far an edge's light reaches: blur, and the chroma's own filter
constexpr double kBlackestCode = 0.004;           ///< darker ones may be clipped, as from kClippingCode on
constexpr double kMaxPixels = 100'000;            ///< looked at in a frame
constexpr int kPaperCells = 4;                    ///< how far the sheet around the print goes on

/// The part of the picture that is looked at.
struct Region {
  const CodeView& codes;
  PixelRect rect;  ///< whole blocks
  std::vector<float> luma, fine;
};

/// Second differences across and along, of unit gain for white noise (Immerkaer 1996), squared; none at the rim.
std::vector<float> fine_squares(const std::vector<float>& luma, const PixelRect& rect) {
  const int width = rect.width;
  std::vector<float> squares(luma.size()), across(static_cast<std::size_t>(width));
  for (int y = 1; y + 1 < rect.height; ++y) {
    const float* middle = &luma[static_cast<std::size_t>(y * width)];
    const float *above = middle - width, *below = middle + width;
    for (int x = 0; x < width; ++x) across[static_cast<std::size_t>(x)] = above[x] - 2 * middle[x] + below[x];
    float* to = &squares[static_cast<std::size_t>(y * width)];
    for (int x = 1; x + 1 < width; ++x) {
      const float* at = &across[static_cast<std::size_t>(x)];
      const float difference = at[-1] - 2 * at[0] + at[1];
      to[x] = difference * difference / 36;
    }
  }
  return squares;
}

void add_block(const Region& region, int column, int row, FlatCell& cell) {
  const glm::ivec2 shift = region.codes.block_shift, size = glm::ivec2(1) << shift;
  const PixelRect& rect = region.rect;
  const glm::dvec3 color(region.codes.color(rect.x + column * size.x, rect.y + row * size.y));
  if (cell.blocks.n == 0) {
    cell.first_block = {column, row};
    cell.first_color = color;
    cell.first_luma = region.luma[static_cast<std::size_t>(row * size.y * rect.width + column * size.x)];
  }
  const glm::dvec2 place = glm::dvec2(column, row) - cell.first_block, corner = place * glm::dvec2(size);
  double sum = 0, least = 1e9, most = -1e9;
  for (int j = 0; j < size.y; ++j)
    for (int i = 0; i < size.x; ++i) {
      const int x = column * size.x + i, y = row * size.y + j;
      const auto index = static_cast<std::size_t>(y * rect.width + x);
      const double luma = region.luma[index], value = luma - cell.first_luma;
      const glm::dvec2 at = corner + glm::dvec2(i, j);
      cell.pixels.add(at);
      cell.luma += value * glm::dvec3(1, at);
      cell.luma_square += value * value;
      sum += value, least = std::min(least, luma), most = std::max(most, luma);
      const bool is_at_rim = x == 0 || y == 0 || x + 1 == rect.width || y + 1 == rect.height;
      cell.fine += is_at_rim ? 0 : region.fine[index];
      cell.fine_count += !is_at_rim;
    }
  const glm::dvec3 base(1, place), value = color - cell.first_color;
  const double block_luma = sum / (size.x * size.y);
  cell.blocks.add(place);
  cell.block_luma += block_luma * base;
  for (int c = 0; c < 3; ++c) cell.color[static_cast<std::size_t>(c)] += value[c] * base;
  cell.color_square += glm::outerProduct(value, value);
  cell.color_luma += value * block_luma;
  if (glm::any(glm::lessThan(least + color, glm::dvec3(kBlackestCode))) ||
      glm::any(glm::greaterThan(most + color, glm::dvec3(kClippingCode))))
    cell.is_clipped = true;
}

struct Place {
  bool is_known = false;
  glm::dvec2 cell{0.0};
  glm::dmat2 cell_per_px{1.0};
};

/// Where the blocks of a row are on the print. Neither a lens nor a slant bends much over some pixels: every kStride-th place is
/// exact, those between are on straight lines.
class RowPlaces {
 public:
  RowPlaces(const CameraModel& camera, const TagView& view, const glm::dvec2& first_px, double step_px)
      : camera_(camera), view_(view), first_px_(first_px), step_px_(step_px), after_(exact(0)) {}

  /// Asked for in order.
  Place at(int index) {
    if (index % kStride == 0) {
      before_ = after_;
      after_ = exact(index + kStride);
    }
    const double share = static_cast<double>(index % kStride) / kStride;
    return {before_.is_known && after_.is_known, glm::mix(before_.cell, after_.cell, share), before_.cell_per_px};
  }

 private:
  static constexpr int kStride = 8;

  Place exact(int index) const {
    const auto place = ideal_pixel(camera_, first_px_ + glm::dvec2(step_px_ * index, 0));
    const auto point = place ? view_.at(place->ideal_px) : std::nullopt;
    return point ? Place{true, point->cell, point->cell_per_px * place->ideal_per_seen} : Place{};
  }

  const CameraModel& camera_;
  const TagView& view_;
  glm::dvec2 first_px_;
  double step_px_;
  Place before_, after_;
};

/// The pixels of print and sheet.
PixelRect region_of(const CameraModel& camera, const RigidTransform& camera_from_tag, const BundledTag& tag, int side) {
  BundledTag larger = tag;
  larger.size_m *= static_cast<double>(side + 2 * kPaperCells) / side;
  return photometry_region(camera, camera_from_tag, TagTarget{larger, {}});
}

/// How far an edge reaches, as a circle in pixels.
double reach_px(const Covariance2& blur_px2, const glm::dvec2& block) {
  return kReachSigmas * std::sqrt(std::max(blur_px2.xx, blur_px2.yy)) + kReachPx + 0.5 * glm::length(block - 1.0);
}

/// The same in cells; hardly changes within one.
glm::dvec2 reach_cells(double reach_px, const glm::dmat2& cell_per_px) {
  const Covariance2 reach = in_cells({reach_px * reach_px, 0, reach_px * reach_px}, cell_per_px);
  return {std::sqrt(reach.xx), std::sqrt(reach.yy)};
}

}  // namespace

std::vector<FlatCell> flat_cells(const CodeView& codes, const CameraModel& camera, const RigidTransform& camera_from_tag,
                                 const BundledTag& tag, const Covariance2& blur_px2) {
  const TagLayout layout = tag_layout(tag.family, tag.id);
  const PixelRect rect = codes.whole_blocks(region_of(camera, camera_from_tag, tag, layout.side()));
  if (rect.empty()) return {};
  Region region{codes, rect, luma_of(codes, rect), {}};
  region.fine = fine_squares(region.luma, rect);
  const TagPattern pattern(layout);
  const TagView view(camera, camera_from_tag, tag.size_m, pattern.cells_across());
  const int margin = layout.margin + kPaperCells, side = layout.cells_across + 2 * margin;
  const glm::dvec2 block(1 << codes.block_shift.x, 1 << codes.block_shift.y), corner(rect.x, rect.y);
  const double reach = reach_px(blur_px2, block), pixels = static_cast<double>(region.luma.size());
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kMaxPixels))));
  std::vector<FlatCell> cells(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  std::vector<glm::dvec2> reaches(cells.size(), glm::dvec2(-1));  // negative: not yet known
  for (int y = 0; y < rect.height >> codes.block_shift.y; y += step) {
    RowPlaces places(camera, view, corner + glm::dvec2(0, y) * block + 0.5 * (block - 1.0), block.x * step);
    for (int x = 0; x < rect.width >> codes.block_shift.x; x += step) {
      const Place place = places.at(x / step);
      const glm::ivec2 at = glm::ivec2(glm::floor(place.cell)) + margin;
      if (!place.is_known || at.x < 0 || at.y < 0 || at.x >= side || at.y >= side) continue;
      const auto index = static_cast<std::size_t>(at.y * side + at.x);
      if (reaches[index].x < 0) reaches[index] = reach_cells(reach, place.cell_per_px);
      if (pattern.around(place.cell, reaches[index]) == TagPattern::Neighbourhood::plateau) add_block(region, x, y, cells[index]);
    }
  }
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      cells[static_cast<std::size_t>(row * side + column)].is_on_print =
          std::min({column, row, side - 1 - column, side - 1 - row}) >= kPaperCells;
  return cells;
}

}  // namespace catchlight::tracking
