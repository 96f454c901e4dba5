#include "tracking/refinement/direct_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "catchlight/rotation.hpp"
#include "catchlight/util/statistics.hpp"
#include "tracking/refinement/tag_view.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kParameters = kSharedParameters + kLightParameters;
/// A pixel's own square spreads light by 1/12 px²; beyond 6 px nothing of any tag is left to see.
constexpr double kMinBlur_px2 = 0.08, kMaxBlur_px2 = 36;

/// Upper triangle and, as a last column, the right side of one part's equations. Plain arrays, rows that start and end at fours,
/// and loops of constant length: this is where the time goes.
struct Sums {
  static constexpr int kColumns = Linearized::kColumns;
  double normal[kParameters][kColumns] = {};

  /// `gradient` has the residual after the parameters.
  void add(const Linearized::Row& gradient, double weight);

  /// The same, where the shared parameters have no gradient.
  void add_light(const Linearized::Row& gradient, double weight);

  template <int kRow>
  [[gnu::always_inline]] void add_row(const Linearized::Row& gradient, double weight) {
    constexpr int kFirst = kRow / 4 * 4;
    const double weighted = weight * gradient[kRow];
    for (int j = kFirst; j < kColumns; ++j) normal[kRow][j] += weighted * gradient[j];
  }

  template <int kFirst, int... kRows>
  [[gnu::always_inline]] void add_rows(const Linearized::Row& gradient, double weight, std::integer_sequence<int, kRows...>) {
    (add_row<kFirst + kRows>(gradient, weight), ...);
  }
};

[[gnu::target_clones("avx2", "default")]] void Sums::add(const Linearized::Row& gradient, double weight) {
  add_rows<0>(gradient, weight, std::make_integer_sequence<int, kParameters>());
}

[[gnu::target_clones("avx2", "default")]] void Sums::add_light(const Linearized::Row& gradient, double weight) {
  add_rows<kSharedParameters>(gradient, weight, std::make_integer_sequence<int, kLightParameters>());
}

struct Sampled {
  PlanePoint point;
  glm::dmat2 cell_per_seen_px;
  PatternSample pattern;
};

/// How one part sees the plane at given parameters.
class PartView {
 public:
  PartView(const CameraModel& camera, const TagPart& part, const DirectParameters& at)
      : pattern_(*part.pattern),
        blur_(at.blur_px2),
        view_(camera, at.camera_from_target * part.target_from_tag, part.size_m, part.pattern->cells_across()) {}

  /// Empty where the plane or the cells there are not known.
  std::optional<Sampled> at(const IdealPixel& place) const {
    const auto point = view_.at(place.ideal_px);
    if (!point) return std::nullopt;
    const glm::dmat2 cell_per_seen_px = point->cell_per_px * place.ideal_per_seen;
    const Covariance2 blur_cells2 = in_cells(blur_, cell_per_seen_px);
    if (!(blur_cells2.xx > 0 && blur_cells2.yy > 0 && blur_cells2.xx < 9 && blur_cells2.yy < 9)) return std::nullopt;
    const Sampled sampled{*point, cell_per_seen_px, pattern_.sample(point->cell, blur_cells2)};
    return sampled.pattern.known ? std::optional(sampled) : std::nullopt;
  }

  /// The place of a cell coordinate across the tag: from -1 at the left and top side to 1.
  glm::dvec2 across(const glm::dvec2& cell) const { return 2.0 * cell / static_cast<double>(pattern_.cells_across()) - 1.0; }

 private:
  const TagPattern& pattern_;
  const Covariance2& blur_;
  TagView view_;
};

double amplitude(const TagLight& light, const glm::dvec2& across) {
  return light.gain + light.gain_u * across.x + light.gain_v * across.y;
}

/// d white share / d shared parameters. The print moves with the pose, and the pixel's place on it the other way.
void shared_gradient(const Sampled& sampled, const CameraModel& camera, const glm::dvec3& origin_m, double scale,
                     Linearized::Row& gradient) {
  const glm::dvec2 slope = glm::transpose(sampled.point.cell_per_px) * sampled.pattern.gradient;  // per ideal pixel
  const glm::dvec3 p = sampled.point.point_camera_m;
  const glm::dvec2 per_m = slope * glm::dvec2(camera.fx_px, camera.fy_px) / p.z;
  const glm::dvec3 moved(per_m, -(per_m.x * p.x + per_m.y * p.y) / p.z);  // d white / d point, negated
  const glm::dvec3 turned = glm::cross(p - origin_m, moved);
  const PatternSample& s = sampled.pattern;
  const glm::dmat2& per_px = sampled.cell_per_seen_px;
  const glm::dmat2 second = glm::transpose(per_px) * glm::dmat2{{s.uu, s.uv}, {s.uv, s.vv}} * per_px;
  for (int i = 0; i < 3; ++i) {
    gradient[i] = -scale * turned[i];
    gradient[3 + i] = -scale * moved[i];
  }
  // Blurring follows the heat equation: the covariance's derivative is half the second derivative in place.
  gradient[6] = scale * second[0][0] / 2;
  gradient[7] = scale * second[1][0];
  gradient[8] = scale * second[1][1] / 2;
}

void add_to(NormalEquations& equations, const Sums& sums) {
  NormalEquations::Part part;
  const auto entry = [&](int i, int j) { return sums.normal[std::min(i, j)][std::max(i, j)]; };
  for (int i = 0; i < kSharedParameters; ++i) {
    equations.right[i] += sums.normal[i][kParameters];
    for (int j = 0; j < kSharedParameters; ++j) equations.shared(i, j) += entry(i, j);
    for (int j = 0; j < kLightParameters; ++j) part.cross(i, j) = entry(i, kSharedParameters + j);
  }
  for (int i = 0; i < kLightParameters; ++i) {
    part.right[i] = sums.normal[kSharedParameters + i][kParameters];
    for (int j = 0; j < kLightParameters; ++j) part.light(i, j) = entry(kSharedParameters + i, kSharedParameters + j);
  }
  equations.parts.push_back(part);
}

/// The nearest covariance whose axes a camera can have.
Covariance2 plausible_blur(const Covariance2& blur) {
  const double middle = (blur.xx + blur.yy) / 2, half = (blur.xx - blur.yy) / 2;
  const double radius = std::hypot(half, blur.xy);
  const double large = std::clamp(middle + radius, kMinBlur_px2, kMaxBlur_px2);
  const double small = std::clamp(middle - radius, kMinBlur_px2, kMaxBlur_px2);
  const double new_middle = (large + small) / 2, shrink = radius > 1e-12 ? (large - small) / 2 / radius : 0;
  return {new_middle + half * shrink, blur.xy * shrink, new_middle - half * shrink};
}

/// The equations of the shared parameters, with each part's light eliminated (Schur's complement).
struct Reduced {
  NormalEquations::Shared shared;
  cv::Vec<double, kSharedParameters> right;
  std::vector<NormalEquations::Light> light_inverse;
};

std::optional<Reduced> reduce(const NormalEquations& equations, double damping) {
  Reduced reduced{equations.shared, equations.right, {}};
  for (int i = 0; i < kSharedParameters; ++i) reduced.shared(i, i) *= 1 + damping;
  for (const NormalEquations::Part& part : equations.parts) {
    NormalEquations::Light light = part.light;
    for (int i = 0; i < kLightParameters; ++i) light(i, i) *= 1 + damping;
    bool solved = false;
    reduced.light_inverse.push_back(light.inv(cv::DECOMP_CHOLESKY, &solved));
    if (!solved) return std::nullopt;
    const NormalEquations::Cross weighted = part.cross * reduced.light_inverse.back();
    reduced.shared -= weighted * part.cross.t();
    reduced.right -= weighted * part.right;
  }
  return reduced;
}

}  // namespace

double RobustLoss::loss(double residual) const {
  const double square = residual * residual;
  return square / 2 / (1 + square / (scale * scale));
}

double RobustLoss::weight(double residual) const {
  const double over = 1 + residual * residual / (scale * scale);
  return 1 / (over * over);
}

std::vector<Residual> DirectModel::residuals(const DirectParameters& at, std::size_t stride) const {
  std::vector<Residual> residuals;
  std::size_t index = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const PartView view(camera_, parts_[i], at);
    for (const TagPixel& pixel : parts_[i].pixels) {
      if (index++ % stride != 0) continue;
      Residual& residual = residuals.emplace_back();
      const auto sampled = view.at(pixel.place);
      if (!sampled) continue;
      const double gain = amplitude(at.light[i], view.across(sampled->point.cell));
      const double code = response_->code(at.light[i].black + gain * sampled->pattern.white).value;
      residual = {true, sampled->pattern.edge, pixel.code - code};
    }
  }
  return residuals;
}

Linearized DirectModel::linearize(const DirectParameters& at) const {
  Linearized result;
  std::size_t pixels = 0;
  for (const TagPart& part : parts_) pixels += part.pixels.size();
  result.residuals.reserve(pixels);
  result.rows.reserve(pixels);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const PartView view(camera_, parts_[i], at);
    const TagLight& light = at.light[i];
    for (const TagPixel& pixel : parts_[i].pixels) {
      Residual& residual = result.residuals.emplace_back();
      Linearized::Row& gradient = result.rows.emplace_back();
      const auto sampled = view.at(pixel.place);
      if (!sampled) continue;
      const glm::dvec2 across = view.across(sampled->point.cell);
      const double white = sampled->pattern.white, gain = amplitude(light, across);
      const ResponseTable::Code code = response_->code(light.black + gain * white);
      residual = {true, sampled->pattern.edge, pixel.code - code.value};
      if (residual.edge) shared_gradient(*sampled, camera_, at.camera_from_target.translation_m, gain * code.slope, gradient);
      double* by_light = gradient.data() + kSharedParameters;
      by_light[0] = code.slope;
      by_light[1] = code.slope * white;
      by_light[2] = by_light[1] * across.x;
      by_light[3] = by_light[1] * across.y;
      gradient[kParameters] = residual.code;
    }
  }
  return result;
}

NormalEquations DirectModel::equations(const Linearized& linearized, const RobustLoss& loss) const {
  NormalEquations equations;
  std::size_t index = 0;
  for (const TagPart& part : parts_) {
    Sums sums;
    for (const std::size_t end = index + part.pixels.size(); index < end; ++index) {
      const Residual& residual = linearized.residuals[index];
      if (!residual.known) continue;
      equations.cost += loss.loss(residual.code);
      const double weight = loss.weight(residual.code);
      residual.edge ? sums.add(linearized.rows[index], weight) : sums.add_light(linearized.rows[index], weight);
    }
    add_to(equations, sums);
  }
  return equations;
}

bool DirectModel::guess_light(DirectParameters& at) const {
  at.light.assign(parts_.size(), {});
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const PartView view(camera_, parts_[i], at);
    std::vector<double> whites, blacks;
    for (const TagPixel& pixel : parts_[i].pixels) {
      const auto sampled = view.at(pixel.place);
      if (sampled) (sampled->pattern.white > 0.5 ? whites : blacks).push_back(pixel.code);
    }
    if (whites.empty() || blacks.empty()) return false;
    // The quartiles are the middles of the darker and the lighter half: what the blur mixes lies in the other halves.
    at.light[i].black = response_->linear_of(quantile(std::move(blacks), 0.25));
    at.light[i].gain = response_->linear_of(quantile(std::move(whites), 0.75)) - at.light[i].black;
    if (!(at.light[i].gain > 0)) return false;
  }
  return true;
}

std::optional<DirectParameters> stepped(const DirectParameters& from, const NormalEquations& equations, double damping,
                                        double stretch) {
  const auto reduced = reduce(equations, damping);
  if (!reduced) return std::nullopt;
  cv::Vec<double, kSharedParameters> step;
  if (!cv::solve(reduced->shared, reduced->right, step, cv::DECOMP_CHOLESKY)) return std::nullopt;
  step *= stretch;
  DirectParameters to = from;
  to.camera_from_target.rotation = rotation_matrix({step[0], step[1], step[2]}) * from.camera_from_target.rotation;
  to.camera_from_target.translation_m += glm::dvec3(step[3], step[4], step[5]);
  to.blur_px2 = plausible_blur({from.blur_px2.xx + step[6], from.blur_px2.xy + step[7], from.blur_px2.yy + step[8]});
  for (std::size_t i = 0; i < equations.parts.size(); ++i) {
    const NormalEquations::Part& part = equations.parts[i];
    const cv::Vec<double, kLightParameters> light = reduced->light_inverse[i] * (stretch * part.right - part.cross.t() * step);
    to.light[i].black += light[0];
    to.light[i].gain += light[1];
    to.light[i].gain_u += light[2];
    to.light[i].gain_v += light[3];
  }
  if (!(to.camera_from_target.translation_m.z > 0) || !std::isfinite(glm::length(to.camera_from_target.translation_m)))
    return std::nullopt;
  return to;
}

std::optional<cv::Matx66d> pose_covariance(const NormalEquations& equations) {
  const auto reduced = reduce(equations, 0);
  if (!reduced) return std::nullopt;
  bool solved = false;
  const NormalEquations::Shared inverse = reduced->shared.inv(cv::DECOMP_CHOLESKY, &solved);
  if (!solved) return std::nullopt;
  return inverse.get_minor<6, 6>(0, 0);
}

}  // namespace catchlight::tracking
