// Fits a tag's whole pattern to the pixels: pose, light, blur and noise at once, each with what it is worth.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tracking/observation.hpp"

namespace catchlight::tracking {

/// Gauss-Newton on
///   code = response(black + light(u, v) · white share(u, v; pose, blur)),
/// where light is linear over each tag. The model is linear light, as lenses blur; residuals are codes, in which both
/// quantisation and photon noise are about even. Geman and McClure's loss discounts fingers and highlights. Blur is any
/// Gaussian, so that motion along a line is one too. Boards have one pose and blur, and light of their own on each tag.
struct DirectFit {
  RigidTransform camera_from_tag;
  PoseCovariance covariance{};
  Covariance2 blur_px2;
  double white_linear = 0, black_linear = 0;  ///< the first seen tag's middle: luma of its white and black, made linear
  double noise_codes = 0;                     ///< robust standard deviation of what the model leaves, in 8-bit codes
  double occluded_share = 0;                  ///< share of the pixels left out, as something is in front of them or near
  double inlier_share = 0;                    ///< share of the other edge pixels that fit within 3 standard deviations
  double explained = 0;                       ///< share of the inliers' variance that the model explains, 0 to 1
  double log_likelihood = 0;                  ///< comparable among the fits of one call
};

struct DirectStart {
  RigidTransform camera_from_tag;
  Covariance2 blur_px2{0.5, 0, 0.5};
  double error_px = 1;  ///< how far the tag may be from there; beyond a pixel, a coarse look goes first
};

class DirectRefiner {
 public:
  /// Throws Error for a family or id that does not exist.
  DirectRefiner(const CameraModel& camera, const TagTarget& target);
  ~DirectRefiner();
  DirectRefiner(DirectRefiner&&) noexcept;
  DirectRefiner& operator=(DirectRefiner&&) noexcept;

  /// Empty where there is too little of the tag in the picture, or no pattern that the pose explains at all.
  /// A fit still has to be judged: see is_convincing().
  std::optional<DirectFit> refine(const LumaView& luma, const DirectStart& start);

  /// The other pose that a planar target allows, where the picture does not rule it out at once; log-likelihoods of both are from
  /// the same pixels then. `fit` is what refine() has just given.
  std::optional<DirectFit> other_pose(DirectFit& fit);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether a fit can only be the tag: its own residual says so.
bool is_convincing(const DirectFit& fit);

}  // namespace catchlight::tracking
