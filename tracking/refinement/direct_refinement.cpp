#include "tracking/refinement/direct_refinement.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/util/statistics.hpp"
#include "tracking/pose/mirrored_pose.hpp"
#include "tracking/pose/planar_pose.hpp"
#include "tracking/refinement/direct_model.hpp"
#include "tracking/refinement/occlusion.hpp"

namespace catchlight::tracking {
namespace {

constexpr std::size_t kMinPixels = 40;
constexpr std::size_t kMaxPixels = 2200, kMaxCoarsePixels = 1000;
constexpr double kCoarseCellPx = 3;      ///< blocks leave cells at least this large: smaller ones run together
constexpr double kLossSigmas = 4;        ///< the loss keeps 93 % of least squares' efficiency on Gaussian noise
constexpr double kMinNoiseCodes = 0.35;  ///< rounding alone leaves 0.29
/// What a frame's own fit may say against the usual: blur changes by a few px², light across a tag by a third.
constexpr double kBlurPrior_px2 = 2, kLightPrior = 0.3;
/// The other planar pose is ruled out without a fit of its own where its corners are this far off, or its pixels speak this much
/// against it.
constexpr double kRuledOutPx = 2.5, kRuledOutLogOdds = 100;
/// Residuals of neighbouring pixels go together (compression, the print's own faults): a pixel counts as this much of one.
constexpr double kIndependence = 0.5;

/// The steps at which minimising ends, in the first round and in those that follow: the next would be a tenth of that.
struct Precision {
  double first_px = 0.1, then_px = 0.01;
};
constexpr Precision kCoarse{0.5, 0.3};  ///< what a fit to single pixels starts from

constexpr std::size_t kSparse = 4;  ///< every so many pixels will do for a first impression

std::vector<Residual> every(const std::vector<Residual>& residuals, std::size_t stride) {
  std::vector<Residual> some;
  for (std::size_t i = 0; i < residuals.size(); i += stride) some.push_back(residuals[i]);
  return some;
}

/// Noise of the edge pixels alone: plateaus would hide that edges are off.
double robust_noise(const std::vector<Residual>& residuals, double least) {
  std::vector<double> sizes;
  sizes.reserve(residuals.size());
  for (const Residual& residual : residuals)
    if (residual.known && residual.edge) sizes.push_back(std::abs(residual.code));
  return sizes.empty() ? least : std::max(least, 1.4826 * median(std::move(sizes)));
}

/// Zero-mean Gaussian priors on the blur's change and the light's slope. An even light has no slope at all.
void add_priors(NormalEquations& equations, const DirectParameters& at, const Covariance2& usual_blur, double noise,
                bool is_light_even) {
  constexpr double kHeld = 1e6;
  const double blur = noise * noise / (kBlurPrior_px2 * kBlurPrior_px2);
  const double off[] = {at.blur_px2.xx - usual_blur.xx, at.blur_px2.xy - usual_blur.xy, at.blur_px2.yy - usual_blur.yy};
  for (int i = 0; i < 3; ++i) {
    equations.shared(6 + i, 6 + i) += blur;
    equations.right[6 + i] -= blur * off[i];
    equations.cost += blur * off[i] * off[i] / 2;
  }
  for (std::size_t i = 0; i < equations.parts.size(); ++i) {
    const TagLight& light = at.light[i];
    const double slope = noise * noise / std::pow(kLightPrior * std::max(light.gain, 1e-3), 2) + (is_light_even ? kHeld : 0.0);
    const double slopes[] = {light.gain_u, light.gain_v};
    for (int k = 0; k < 2; ++k) {
      equations.parts[i].light(2 + k, 2 + k) += slope;
      equations.parts[i].right[2 + k] -= slope * slopes[k];
      equations.cost += slope * slopes[k] * slopes[k] / 2;
    }
  }
}

/// Largest side of the target in pixels over its distance: turns a motion in metres and radians into pixels.
double moved_px(const CameraModel& camera, const DirectParameters& from, const DirectParameters& to, double reach_m) {
  const glm::dvec3 shift_m = to.camera_from_target.translation_m - from.camera_from_target.translation_m;
  const glm::dmat3 turn = to.camera_from_target.rotation - from.camera_from_target.rotation;
  const double moved_m = glm::length(shift_m) + reach_m * std::max(glm::length(turn[0]), glm::length(turn[1]));
  return camera.fx_px * moved_m / to.camera_from_target.translation_m.z;
}

}  // namespace

struct DirectRefiner::Impl {
  CameraModel camera;
  TagTarget target;
  std::vector<BundledTag> tags;
  std::vector<TagPattern> patterns;
  IdealPixels ideal_pixels;
  std::optional<ResponseTable> response;
  double reach_m = 0;                  ///< from the target's origin to its farthest corner
  std::optional<PlanarSquare> square;  ///< around a flat target

  Impl(const CameraModel& camera_model, const TagTarget& tag_target)
      : camera(camera_model), target(tag_target), tags(tag_target.tags()), ideal_pixels(camera_model) {
    for (const BundledTag& tag : tags) {
      patterns.emplace_back(tag_layout(tag.family, tag.id));
      for (const glm::dvec3& corner_m : tag_corners_m(tag.size_m))
        reach_m = std::max(reach_m, glm::length(tag.tag_from_this * corner_m));
    }
    square = planar_square(tags);
  }

  /// Smallest cell of the target as seen, px.
  double cell_px(const RigidTransform& camera_from_target) const {
    double smallest = 1e9;
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const int cells = patterns[i].cells_across();
      const TagView view(camera, camera_from_target * tags[i].tag_from_this, tags[i].size_m, cells);
      const auto middle = view.ideal_px(glm::dvec2(cells / 2.0)), right = view.ideal_px({cells / 2.0 + 1, cells / 2.0});
      const auto below = view.ideal_px({cells / 2.0, cells / 2.0 + 1});
      if (middle && right && below)
        smallest = std::min({smallest, glm::distance(*middle, *right), glm::distance(*middle, *below)});
    }
    return smallest;
  }

  DirectModel model_at(const LumaView& luma, const DirectParameters& at, const PixelChoice& choice) {
    std::vector<TagPart> parts;
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const RigidTransform camera_from_tag = at.camera_from_target * tags[i].tag_from_this;
      if (glm::dot(camera_from_tag.rotation[2], camera_from_tag.translation_m) >= 0) continue;  // its back
      const TagView view(camera, camera_from_tag, tags[i].size_m, patterns[i].cells_across());
      PixelChoice share = choice;
      share.most = std::max(choice.most / tags.size(), 4 * kMinPixels);
      auto pixels = choose_pixels(luma, camera, ideal_pixels, *response, patterns[i], view, share);
      if (pixels.size() < kMinPixels) continue;
      parts.push_back({&patterns[i], tags[i].size_m, tags[i].tag_from_this, std::move(pixels)});
    }
    return {camera, *response, std::move(parts)};
  }

  /// A fit under way.
  struct Fit {
    DirectParameters at;
    Linearized linearized;      ///< there
    NormalEquations equations;  ///< of that, for the noise
    double noise = 0;
    double kept_share = 1;  ///< the pixels that are not occluded
    double moved_px = 1e9;  ///< by the last step
    bool is_another_print = false;
    bool is_light_even = false;  ///< not yet let slope: a dark occluder would pass for a slope far from the solution
  };

  /// The equations at `at`, where the model is linearized, as the fit's noise weighs them.
  NormalEquations equations(const DirectModel& model, const DirectParameters& at, const Linearized& linearized, const Fit& fit,
                            const Covariance2& usual_blur) const {
    NormalEquations equations = model.equations(linearized, {kLossSigmas * fit.noise});
    add_priors(equations, at, usual_blur, fit.noise, fit.is_light_even);
    return equations;
  }

  /// Levenberg-Marquardt at one level of noise.
  void minimize(const DirectModel& model, Fit& fit, const Covariance2& usual_blur, double until_px) const {
    constexpr int kMaxSteps = 10;
    constexpr double kFirstDamping = 1e-4, kMaxDamping = 1e3;
    // Weights that fall with the residual make the cost flatter than Gauss-Newton takes it for: its steps are a quarter too
    // short.
    constexpr double kNearPx = 1, kStretch = 1.3;
    double damping = kFirstDamping;
    for (int step = 0; step < kMaxSteps; ++step) {
      const double stretch = fit.moved_px < kNearPx ? kStretch : 1;
      const auto next = stepped(fit.at, fit.equations, damping, stretch);
      Linearized there;
      NormalEquations equations_there;
      if (next) there = model.linearize(*next), equations_there = equations(model, *next, there, fit, usual_blur);
      if (!next || !(equations_there.cost <= fit.equations.cost)) {
        damping = std::max(damping, 1e-3) * 10;
        if (damping > kMaxDamping) return;
        continue;
      }
      fit.moved_px = moved_px(camera, fit.at, *next, reach_m);
      fit.at = *next;
      fit.linearized = std::move(there);
      fit.equations = std::move(equations_there);
      damping = std::max(damping / 10, 1e-7);
      if (fit.moved_px < until_px) return;
    }
  }

  /// Minimises with the noise that the start has, then with what is left of it, as long as it falls: under a lenient loss, what
  /// occludes a part of the tag still pulls.
  Fit solve(const DirectModel& model, const DirectParameters& start, const Precision& precision = {}) const {
    constexpr int kMaxRounds = 6;
    constexpr double kFallen = 0.9;
    const double least = kMinNoiseCodes / response->codes_per_unit();
    Fit fit{start, model.linearize(start), {}};
    fit.noise = robust_noise(every(fit.linearized.residuals, kSparse), least);
    const auto has_slope = [](const TagLight& light) { return light.gain_u != 0 || light.gain_v != 0; };
    fit.is_light_even = std::none_of(start.light.begin(), start.light.end(), has_slope);
    fit.equations = equations(model, fit.at, fit.linearized, fit, start.blur_px2);
    for (int round = 0; round < kMaxRounds; ++round) {
      minimize(model, fit, start.blur_px2, round == 0 ? precision.first_px : precision.then_px);
      const double noise = robust_noise(fit.linearized.residuals, least);
      const bool has_fallen = noise < kFallen * fit.noise;
      if (round > 0 && !has_fallen) break;
      if (!has_fallen && !fit.is_light_even) continue;
      fit.noise = noise;
      fit.is_light_even = false;
      fit.equations = equations(model, fit.at, fit.linearized, fit, start.blur_px2);
    }
    return fit;
  }

  /// Solves with all pixels, then without those that are occluded: `model` keeps the pixels that count.
  Fit solve_unoccluded(DirectModel& model, const DirectParameters& start) const {
    constexpr int kMaxRounds = 2;  // the first leaves less noise, in which fainter occluders show
    Fit fit = solve(model, start);
    fit.is_another_print = shows_another_print(camera, *response, model.parts(), fit.at);
    for (int round = 0; round < kMaxRounds && !fit.is_another_print; ++round) {
      auto unoccluded = leave_out_occluded(camera, model, fit.at, fit.linearized.residuals, {kLossSigmas * fit.noise});
      if (!unoccluded) break;
      model = DirectModel(camera, *response, std::move(unoccluded->parts));
      DirectParameters again = fit.at;
      again.light = unoccluded->light;
      const double kept_share = fit.kept_share * unoccluded->kept_share;
      fit = solve(model, again);
      fit.kept_share = kept_share;
    }
    return fit;
  }

  double log_likelihood(const std::vector<Residual>& residuals, double noise) const {
    const RobustLoss loss{kLossSigmas * noise};
    double losses = 0;
    for (const Residual& residual : residuals)
      if (residual.known) losses += loss.loss(residual.code);
    return -kIndependence * losses / (noise * noise);
  }

  /// The model of the pixels around `at`, and light for it; empty where they show nothing of the target.
  std::optional<DirectModel> model_with_light(const LumaView& luma, DirectParameters& at, const PixelChoice& choice) {
    DirectModel model = model_at(luma, at, choice);
    if (model.parts().empty()) return std::nullopt;
    if (at.light.size() != model.parts().size() && !model.guess_light(at)) return std::nullopt;
    return model;
  }

  /// A coarse look at blocks of pixels, which reaches farther.
  bool approach(const LumaView& luma, DirectParameters& at, double error_px) {
    const int block =
        std::min(static_cast<int>(std::lround(error_px)), static_cast<int>(cell_px(at.camera_from_target) / kCoarseCellPx));
    if (block < 2) return true;
    const double box_px2 = (block * block - 1) / 12.0;
    at.blur_px2 = {at.blur_px2.xx + box_px2, at.blur_px2.xy, at.blur_px2.yy + box_px2};
    const auto model = model_with_light(luma, at, {at.blur_px2, error_px / 2, block, kMaxCoarsePixels});
    if (!model) return false;
    at = solve(*model, at, kCoarse).at;
    at.blur_px2 = {std::max(at.blur_px2.xx - box_px2, 0.1), at.blur_px2.xy, std::max(at.blur_px2.yy - box_px2, 0.1)};
    return true;
  }

  /// What refine() found last.
  struct Solved {
    DirectModel model;
    Fit fit;
  };
  std::optional<Solved> last;

  /// What a finished fit is worth.
  std::optional<DirectFit> judged(const DirectModel& model, const Fit& fit) const {
    const auto covariance = pose_covariance(fit.equations);
    if (!covariance || fit.is_another_print) return std::nullopt;
    DirectFit result;
    result.camera_from_tag = fit.at.camera_from_target;
    for (int i = 0; i < 36; ++i)
      result.covariance[static_cast<std::size_t>(i)] = fit.noise * fit.noise / kIndependence * covariance->val[i];
    result.blur_px2 = fit.at.blur_px2;
    result.black_linear = fit.at.light[0].black;
    result.white_linear = fit.at.light[0].black + fit.at.light[0].gain;
    result.noise_codes = fit.noise * response->codes_per_unit();
    const RobustLoss loss{kLossSigmas * fit.noise};
    double edges = 0, inliers = 0, n = 0, sum = 0, squares = 0, left = 0;
    std::size_t index = 0;
    for (const TagPart& part : model.parts())
      for (const TagPixel& pixel : part.pixels) {
        const Residual& residual = fit.linearized.residuals[index++];
        if (!residual.known) continue;
        const double weight = loss.weight(residual.code);
        n += weight, sum += weight * pixel.code, squares += weight * pixel.code * pixel.code;
        left += weight * residual.code * residual.code;
        edges += residual.edge;
        inliers += residual.edge && std::abs(residual.code) < 3 * fit.noise;
      }
    if (!(edges > 0) || !(n > 0)) return std::nullopt;
    result.inlier_share = inliers / edges;
    result.occluded_share = 1 - fit.kept_share;
    result.explained = 1 - left / std::max(squares - sum * sum / n, 1e-12);
    result.log_likelihood = log_likelihood(fit.linearized.residuals, fit.noise);
    return result;
  }
};

DirectRefiner::DirectRefiner(const CameraModel& camera, const TagTarget& target)
    : impl_(std::make_unique<Impl>(camera, target)) {}
DirectRefiner::~DirectRefiner() = default;
DirectRefiner::DirectRefiner(DirectRefiner&&) noexcept = default;
DirectRefiner& DirectRefiner::operator=(DirectRefiner&&) noexcept = default;

std::optional<DirectFit> DirectRefiner::refine(const LumaView& luma, const DirectStart& start) {
  Impl& impl = *impl_;
  impl.last.reset();
  if (!impl.response || !impl.response->fits(luma)) impl.response.emplace(luma);
  DirectParameters at{start.camera_from_tag, start.blur_px2, {}};
  if (!impl.approach(luma, at, start.error_px)) return std::nullopt;
  auto model = impl.model_with_light(luma, at, {at.blur_px2, std::min(start.error_px, 1.0) / 2, 1, kMaxPixels});
  if (!model) return std::nullopt;
  Impl::Fit fit = impl.solve_unoccluded(*model, at);
  impl.last.emplace(Impl::Solved{std::move(*model), std::move(fit)});
  return impl.judged(impl.last->model, impl.last->fit);
}

std::optional<DirectFit> DirectRefiner::other_pose(DirectFit& fit) {
  Impl& impl = *impl_;
  if (!impl.square || !impl.last) return std::nullopt;
  const auto other = mirrored(impl.camera, *impl.square, fit.camera_from_tag);
  if (!other || other->reprojection_rms_px > kRuledOutPx) return std::nullopt;

  const DirectModel& model = impl.last->model;
  Impl::Fit& first = impl.last->fit;
  DirectParameters there = first.at;
  there.camera_from_target = other->camera_from_tag;
  const double odds = kSparse * (impl.log_likelihood(every(first.linearized.residuals, kSparse), first.noise) -
                                 impl.log_likelihood(model.residuals(there, kSparse), first.noise));
  if (odds > kRuledOutLogOdds) return std::nullopt;
  Impl::Fit second = impl.solve(model, there);
  second.kept_share = first.kept_share;
  constexpr double kSameAxis = 5e-3;  // a quarter of a degree: it came back
  const glm::dmat3 turn = second.at.camera_from_target.rotation - first.at.camera_from_target.rotation;
  if (std::max(glm::length(turn[0]), glm::length(turn[1])) < kSameAxis) return std::nullopt;

  const double noise = std::min(first.noise, second.noise);
  for (Impl::Fit* each : {&first, &second}) {
    each->noise = noise;
    each->is_light_even = false;
    each->equations = impl.equations(model, each->at, each->linearized, *each, fit.blur_px2);
  }
  const auto first_judged = impl.judged(model, first), second_judged = impl.judged(model, second);
  if (!first_judged || !second_judged) return std::nullopt;
  fit = *first_judged;
  return second_judged;
}

bool is_convincing(const DirectFit& fit) {
  return fit.white_linear > fit.black_linear && fit.explained > 0.8 && fit.inlier_share > 0.5;
}

}  // namespace catchlight::tracking
