#include "tracking/camera/grain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "catchlight/color.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/response.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/util/statistics.hpp"
#include "tracking/camera/photometry.hpp"
#include "tracking/refinement/ideal_pixels.hpp"
#include "tracking/refinement/tag_pattern.hpp"
#include "tracking/refinement/tag_view.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kReachSigmas = 3, kReachPx = 1;  ///< how far an edge's light reaches: blur, and the chroma's own filter
constexpr std::size_t kMinBlocks = 8;             ///< a cell's
constexpr double kMaxOfMedian = 2.5;              ///< a cell with more variance is not flat
constexpr double kBlackestCode = 0.004;           ///< darker ones may be clipped, as from kClippingCode on
constexpr double kMaxPixels = 100'000;            ///< looked at in a frame
constexpr double kNoiselessLight = 0.03;          ///< the darkest that may be without noise
constexpr int kPaperCells = 4;                    ///< how far the sheet around the print goes on
constexpr double kPaperLikeness = 0.15;           ///< the sheet's light differs by no more from the print's white
constexpr double kMaxOfFine = 3;                  ///< grain smeared by a codec has no more; else it is texture
constexpr double kWeightFloor = 0.02;             ///< variance grows about as light + this, so that its own error does too

/// What is left of values at places after their best plane.
template <class Value>
void take_off_plane(const std::vector<glm::dvec2>& places, std::vector<Value>& values) {
  glm::dmat3 normal(0.0);
  glm::dvec2 middle(0.0);
  for (const glm::dvec2& place : places) middle += place / static_cast<double>(places.size());
  std::array<Value, 3> right{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec3 base(1, places[i] - middle);
    normal += glm::outerProduct(base, base);
    for (int k = 0; k < 3; ++k) right[static_cast<std::size_t>(k)] += values[i] * base[k];
  }
  const glm::dmat3 inverse = glm::inverse(normal);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec3 weights = inverse * glm::dvec3(1, places[i] - middle);
    for (int k = 0; k < 3; ++k) values[i] -= right[static_cast<std::size_t>(k)] * weights[k];
  }
}

/// A plane needs places that are not on one line, as a narrow cell's may be.
bool span_a_plane(const std::vector<glm::dvec2>& places) {
  constexpr double kMinSpread = 0.1;  // two rows of four have 0.3
  glm::dvec2 middle(0.0);
  glm::dmat2 spread(0.0);
  const double share = 1.0 / static_cast<double>(places.size());
  for (const glm::dvec2& place : places) middle += share * place;
  for (const glm::dvec2& place : places) spread += share * glm::outerProduct(place - middle, place - middle);
  return glm::determinant(spread) >= kMinSpread;
}

/// The blocks of a cell that no edge's light reaches.
struct CellBlocks {
  std::vector<glm::dvec2> block_places, pixel_places;
  std::vector<glm::dvec3> color;
  std::vector<double> luma, block_luma, fine;
  bool is_clipped = false, is_on_print = true;
};

/// Second difference across and along, of unit gain for white noise (Immerkaer 1996); none at the rim.
std::optional<double> fine_difference(const CodePlanes& planes, int x, int y) {
  if (x < 1 || y < 1 || x + 1 >= planes.rect.width || y + 1 >= planes.rect.height) return std::nullopt;
  double difference = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i)
      difference += (i ? 1 : -2) * (j ? 1 : -2) *
                    static_cast<double>(planes.luma[static_cast<std::size_t>((y + j) * planes.rect.width + x + i)]);
  return difference / 6;
}

void add_block(const CodePlanes& planes, int column, int row, CellBlocks& cell) {
  const glm::ivec2 size(1 << planes.block_shift.x, 1 << planes.block_shift.y);
  const glm::dvec3 color(planes.color[static_cast<std::size_t>(row * planes.blocks_across() + column)]);
  double sum = 0;
  for (int y = row * size.y; y < (row + 1) * size.y; ++y)
    for (int x = column * size.x; x < (column + 1) * size.x; ++x) {
      const double luma = planes.luma[static_cast<std::size_t>(y * planes.rect.width + x)];
      cell.luma.push_back(luma);
      cell.pixel_places.emplace_back(x, y);
      if (const auto fine = fine_difference(planes, x, y)) cell.fine.push_back(*fine * *fine);
      sum += luma;
      const glm::dvec3 rgb = luma + color;
      if (glm::any(glm::lessThan(rgb, glm::dvec3(kBlackestCode))) || glm::any(glm::greaterThan(rgb, glm::dvec3(kClippingCode))))
        cell.is_clipped = true;
    }
  cell.block_luma.push_back(sum / (size.x * size.y));
  cell.block_places.emplace_back(column, row);
  cell.color.push_back(color);
}

/// Light per code: the slope of the curve.
double slope_at(const PlateColor& response, double code, int channel) {
  constexpr double kStep = 1.0 / 255;  // no finer than measured curves are
  return (linear_from_code(response, code + kStep, channel) - linear_from_code(response, code - kStep, channel)) / (2 * kStep);
}

template <class Value>
Value mean(const std::vector<Value>& values) {
  Value sum(0.0);
  for (const Value& value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Least squares of slope and floor, from sums of weight, light, variance and their products. The slope is not negative; the
/// floor may be by a little: codecs wipe out what is left of the grain in the dark.
glm::dvec2 line(double w, double wi, double wii, double wv, double wiv) {
  if (!(w > 0 && wii > 0)) return glm::dvec2(0.0);
  const double determinant = w * wii - wi * wi;
  if (determinant <= 1e-6 * w * wii) return {std::max(wiv / wii, 0.0), 0};
  const double slope = (w * wiv - wi * wv) / determinant, floor = (wii * wv - wi * wiv) / determinant;
  if (slope < 0) return {0, std::max(wv / w, 0.0)};
  if (floor >= -kNoiselessLight * slope) return {slope, floor};
  const double through = (wiv - kNoiselessLight * wv) / (wii - 2 * kNoiselessLight * wi + kNoiselessLight * kNoiselessLight * w);
  return through > 0 ? glm::dvec2(through, -kNoiselessLight * through) : glm::dvec2(0.0);
}

/// The part of each cell, of the print and of the sheet that may go on around it, that is far enough from every edge of the
/// print.
std::vector<CellBlocks> cells_of(const CodePlanes& planes, const CameraModel& camera, const RigidTransform& camera_from_tag,
                                 const BundledTag& tag, const Covariance2& blur_px2) {
  const TagPattern pattern(tag_layout(tag.family, tag.id));
  const TagView view(camera, camera_from_tag, tag.size_m, pattern.cells_across());
  const int margin = pattern.margin() + kPaperCells, side = pattern.cells_across() + 2 * margin;
  const glm::dvec2 block(1 << planes.block_shift.x, 1 << planes.block_shift.y);
  const double reach_px =
      kReachSigmas * std::sqrt(std::max(blur_px2.xx, blur_px2.yy)) + kReachPx + 0.5 * glm::length(block - 1.0);
  const double reach_px2 = reach_px * reach_px, pixels = static_cast<double>(planes.luma.size());
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kMaxPixels))));
  std::vector<CellBlocks> cells(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int y = 0; y < planes.rect.height >> planes.block_shift.y; y += step)
    for (int x = 0; x < planes.blocks_across(); x += step) {
      const glm::dvec2 at = glm::dvec2(planes.rect.x, planes.rect.y) + glm::dvec2(x, y) * block + 0.5 * (block - 1.0);
      const auto place = ideal_pixel(camera, at);
      const auto point = place ? view.at(place->ideal_px) : std::nullopt;
      if (!point) continue;
      const Covariance2 reach = in_cells({reach_px2, 0, reach_px2}, point->cell_per_px * place->ideal_per_seen);
      using enum TagPattern::Neighbourhood;
      if (pattern.around(point->cell, {std::sqrt(reach.xx), std::sqrt(reach.yy)}) != plateau) continue;
      const glm::ivec2 cell = glm::ivec2(glm::floor(point->cell)) + margin;
      if (cell.x < 0 || cell.y < 0 || cell.x >= side || cell.y >= side) continue;
      add_block(planes, x, y, cells[static_cast<std::size_t>(cell.y * side + cell.x)]);
    }
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      cells[static_cast<std::size_t>(row * side + column)].is_on_print =
          std::min({column, row, side - 1 - column, side - 1 - row}) >= kPaperCells;
  return cells;
}

double trace(const glm::dmat3& m) {
  return m[0][0] + m[1][1] + m[2][2];
}

/// Covariance of RGB less luma.
glm::dmat3 of_color(const glm::dmat3& covariance) {
  const glm::dmat3 less_luma = glm::dmat3(1.0) - glm::outerProduct(glm::dvec3(1.0), kLuminanceWeights);
  return less_luma * covariance * glm::transpose(less_luma);
}

/// The pixels of print and sheet.
PixelRect region_of(const CameraModel& camera, const RigidTransform& camera_from_tag, const BundledTag& tag) {
  const TagLayout layout = tag_layout(tag.family, tag.id);
  BundledTag larger = tag;
  larger.size_m *= static_cast<double>(layout.side() + 2 * kPaperCells) / layout.side();
  return photometry_region(camera, camera_from_tag, TagTarget{larger, {}});
}

FlatPatch flat_of(CellBlocks& cell, const glm::dmat3& rounding, const PlateColor& response) {
  const glm::dvec3 code = mean(cell.luma) + mean(cell.color), one(1.0);
  take_off_plane(cell.pixel_places, cell.luma);
  take_off_plane(cell.block_places, cell.block_luma);
  take_off_plane(cell.block_places, cell.color);
  FlatPatch flat;
  for (const double luma : cell.luma) flat.luma_variance += luma * luma / static_cast<double>(cell.luma.size() - 3);
  flat.fine_variance = cell.fine.empty() ? flat.luma_variance : mean(cell.fine);
  flat.freedom = static_cast<double>(cell.color.size() - 3);
  flat.is_on_print = cell.is_on_print;
  glm::dmat3 covariance = glm::outerProduct(one, one) * flat.luma_variance;
  for (std::size_t i = 0; i < cell.color.size(); ++i) {
    const glm::dvec3& color = cell.color[i];
    covariance +=
        (glm::outerProduct(color, color) + (glm::outerProduct(one, color) + glm::outerProduct(color, one)) * cell.block_luma[i]) /
        flat.freedom;
  }
  glm::dvec3 slope(0.0);
  for (int c = 0; c < 3; ++c) {
    slope[c] = slope_at(response, code[c], c);
    flat.light[c] = linear_from_code(response, code[c], c);
  }
  // Colour that varies by less than a code is not rounded at random: no more is taken off than there is.
  const glm::dmat3 of_luma = glm::outerProduct(one, one) * glm::dot(kLuminanceWeights, rounding * kLuminanceWeights);
  const double rounded = trace(of_color(rounding)), seen = trace(of_color(covariance));
  const glm::dmat3 taken_off = of_luma + (rounding - of_luma) * (rounded > 0 ? std::clamp(seen / rounded, 0.0, 1.0) : 0.0);
  flat.covariance = glm::matrixCompMult(covariance - taken_off, glm::outerProduct(slope, slope));
  return flat;
}

}  // namespace

void GrainMeter::add(const FrameImage& frame, const TrackRow& row) {
  if (row.state != TrackState::tracking || !(row.noise_codes > 0)) return;
  for (const BundledTag& tag : target_.tags()) add_tag(frame, row, tag);
}

void GrainMeter::add_tag(const FrameImage& frame, const TrackRow& row, const BundledTag& tag) {
  const RigidTransform camera_from_tag = row.camera_from_tag * tag.tag_from_this;
  const CodeView codes = frame.codes();
  const CodePlanes planes = code_planes(codes, region_of(camera_, camera_from_tag, tag));
  if (planes.rect.empty()) return;
  std::vector<FlatPatch> flats;
  for (CellBlocks& cell : cells_of(planes, camera_, camera_from_tag, tag, row.blur_px2))
    if (cell.color.size() >= kMinBlocks && !cell.is_clipped && span_a_plane(cell.block_places))
      flats.push_back(flat_of(cell, codes.rounding, frame.color()));
  const auto paper = std::ranges::partition(flats, &FlatPatch::is_on_print);
  const std::span<const FlatPatch> print(flats.begin(), paper.begin());
  if (print.empty()) return;
  // Each ink by itself: what is much for black is little for white.
  const auto [low, high] = std::ranges::minmax_element(print, {}, [](const FlatPatch& flat) { return flat.light.g; });
  const double between = (low->light.g + high->light.g) / 2;
  std::vector<FlatPatch> black, white;
  for (const FlatPatch& flat : print) (flat.light.g <= between ? black : white).push_back(flat);
  add_alike(black, {});
  add_alike(white, paper);
}

void GrainMeter::add_alike(std::span<const FlatPatch> flats, std::span<const FlatPatch> paper) {
  if (flats.empty()) return;
  std::vector<double> variances;
  glm::dvec3 light(0.0);
  for (const FlatPatch& flat : flats) {
    variances.push_back(flat.luma_variance);
    light += flat.light / static_cast<double>(flats.size());
  }
  const double most = kMaxOfMedian * median(std::move(variances));
  std::vector<FlatPatch> counted;
  for (const FlatPatch& flat : paper)
    if (flat.luma_variance <= most && glm::all(glm::lessThan(glm::abs(flat.light - light), kPaperLikeness * light)))
      counted.push_back(flat);
  if (counted.size() < flats.size())
    for (const FlatPatch& flat : flats)
      if (flat.luma_variance <= most) counted.push_back(flat);
  double all = 0, fine = 0;
  for (const FlatPatch& flat : counted) all += flat.freedom * flat.luma_variance, fine += flat.freedom * flat.fine_variance;
  const double grain = all > 0 ? std::min(1.0, kMaxOfFine * fine / all) : 1.0;
  for (FlatPatch& flat : counted) {
    flat.covariance *= grain;
    add(flat);
  }
}

void GrainMeter::add(const FlatPatch& flat) {
  const glm::dvec3 light = glm::max(flat.light, glm::dvec3(0.0));
  for (int c = 0; c < 3; ++c) {
    const double i = light[c], v = flat.covariance[c][c], w = flat.freedom / ((i + kWeightFloor) * (i + kWeightFloor));
    w_[c] += w, wi_[c] += w * i, wii_[c] += w * i * i, wv_[c] += w * v, wiv_[c] += w * i * v;
  }
  together_ += flat.covariance * (flat.freedom / (glm::dot(kLuminanceWeights, light) + kWeightFloor));
}

NoiseModel GrainMeter::model() const {
  NoiseModel model;
  for (int c = 0; c < 3; ++c) {
    const glm::dvec2 of_channel = line(w_[c], wi_[c], wii_[c], wv_[c], wiv_[c]);
    model.slope[c] = of_channel.x;
    model.floor[c] = of_channel.y;
  }
  const auto correlation = [&](int a, int b) {
    const double scale = together_[a][a] > 0 && together_[b][b] > 0 ? std::sqrt(together_[a][a] * together_[b][b]) : 0;
    return scale > 0 ? std::clamp(together_[a][b] / scale, -1.0, 1.0) : 0.0;
  };
  model.correlation = {correlation(0, 1), correlation(0, 2), correlation(1, 2)};
  return model;
}

}  // namespace catchlight::tracking
