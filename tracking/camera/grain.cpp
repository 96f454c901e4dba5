#include "tracking/camera/grain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "catchlight/color.hpp"
#include "catchlight/response.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/util/statistics.hpp"
#include "tracking/camera/flat_cells.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kMinBlocks = 8;          ///< a cell's
constexpr double kMinSpread = 0.1;        ///< a narrow cell's may be on one line; two rows of four have 0.3
constexpr double kMaxOfMedian = 2.5;      ///< a cell with more variance is not flat
constexpr double kNoiselessLight = 0.03;  ///< the darkest that may be without noise
constexpr double kPaperLikeness = 0.15;   ///< the sheet's light differs by no more from the print's white
constexpr double kMaxOfFine = 3;          ///< grain smeared by a codec has no more; else it is texture
constexpr double kWeightFloor = 0.02;     ///< variance grows about as light + this, so that its own error does too

/// Light per code: the slope of the curve.
double slope_at(const PlateColor& response, double code, int channel) {
  constexpr double kStep = 1.0 / 255;  // no finer than measured curves are
  return (linear_from_code(response, code + kStep, channel) - linear_from_code(response, code - kStep, channel)) / (2 * kStep);
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

double trace(const glm::dmat3& m) {
  return m[0][0] + m[1][1] + m[2][2];
}

/// Covariance of RGB less luma.
glm::dmat3 of_color(const glm::dmat3& covariance) {
  const glm::dmat3 less_luma = glm::dmat3(1.0) - glm::outerProduct(glm::dvec3(1.0), kLuminanceWeights);
  return less_luma * covariance * glm::transpose(less_luma);
}

/// Covariance of the codes that a cell's plane leaves. Luma's variance is a pixel's, all that has to do with colour a block's.
glm::dmat3 code_covariance(const FlatCell& cell, double luma_variance) {
  const glm::dmat3 inverse = cell.blocks.inverse();
  const double freedom = cell.blocks.n - 3;
  glm::dmat3 covariance(luma_variance);
  glm::dvec3 with_luma;
  for (int c = 0; c < 3; ++c)
    with_luma[c] = left_over(cell.color_luma[c], cell.color[static_cast<std::size_t>(c)], cell.block_luma, inverse) / freedom;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      covariance[i][j] = luma_variance + with_luma[i] + with_luma[j] +
                         left_over(cell.color_square[i][j], cell.color[static_cast<std::size_t>(i)],
                                   cell.color[static_cast<std::size_t>(j)], inverse) /
                             freedom;
  return covariance;
}

FlatPatch flat_of(const FlatCell& cell, const glm::dmat3& rounding, const PlateColor& response) {
  const glm::dvec3 one(1.0), color(cell.color[0].x, cell.color[1].x, cell.color[2].x);
  const glm::dvec3 code = cell.first_luma + cell.luma.x / cell.pixels.n + cell.first_color + color / cell.blocks.n;
  FlatPatch flat;
  flat.luma_variance = left_over(cell.luma_square, cell.luma, cell.luma, cell.pixels.inverse()) / (cell.pixels.n - 3);
  flat.fine_variance = cell.fine_count > 0 ? cell.fine / cell.fine_count : flat.luma_variance;
  flat.freedom = cell.blocks.n - 3;
  flat.is_on_print = cell.is_on_print;
  const glm::dmat3 covariance = code_covariance(cell, flat.luma_variance);
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
  const PlateColor color = frame.color();
  std::vector<FlatPatch> flats;
  for (const FlatCell& cell : flat_cells(codes, camera_, camera_from_tag, tag, row.blur_px2))
    if (cell.blocks.n >= kMinBlocks && !cell.is_clipped && cell.blocks.spread() >= kMinSpread)
      flats.push_back(flat_of(cell, codes.rounding, color));
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
