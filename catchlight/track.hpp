// The track: what tracking knows of every frame, and all that rendering asks of it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "catchlight/rigid_transform.hpp"

namespace catchlight {

/// Covariance of a two-dimensional spread, such as the camera's blur in px².
struct Covariance2 {
  double xx = 0, xy = 0, yy = 0;
};

/// Covariance of a pose, row-major 6x6: a small rotation (rad) about the camera's x, y, z axes through the tag's origin, then a
/// translation (m) in the camera frame.
using PoseCovariance = std::array<double, 36>;

enum class TrackState {
  tracking,  ///< seen in this frame
  coasting,  ///< not seen; the pose is predicted from the last frames
  lost       ///< no pose
};
constexpr auto names_of(TrackState) {
  return std::array{"tracking", "coasting", "lost"};
}

/// Variance of a channel, of exposed linear light in the footage's primaries = slope * value + floor: shot noise and read noise
/// (Foi et al. 2008, "Practical Poissonian-Gaussian noise modeling and fitting for single-image raw-data"). Of footage whose
/// colour is subsampled, luma's noise and that of the nearest colour sample together.
struct NoiseModel {
  glm::dvec3 slope{0.0}, floor{0.0};
  glm::dvec3 correlation{0.0};  ///< red with green, red with blue, green with blue

  bool is_measured() const { return slope != glm::dvec3(0.0) || floor != glm::dvec3(0.0); }
};

/// How the tag moves in the camera frame from one frame to the next: a point X of it by turn x X + shift.
struct TagMotion {
  glm::dvec3 turn_rad{0.0}, shift_m{0.0};
};

/// What blurs the picture.
struct BlurModel {
  TagMotion motion;
  double shutter = 0;    ///< share of the frame's interval that it is open; 0: the footage shows no motion blur
  double focus_px2 = 0;  ///< variance along each axis by lens and pixel, without motion; 0: not measured
  /// How far the camera turned about its x and y axes while the shutter was open, beyond what shutter and motion say: a jerk that
  /// this frame's own blur shows.
  glm::dvec2 shake_rad{0.0};
};

/// What is known of one frame: its pose, its exposure and what the camera did to it.
struct TrackRow {
  std::int64_t frame = 0;
  double time_s = 0;
  bool found = false;
  RigidTransform camera_from_tag;
  std::optional<PoseCovariance> pose_covariance;  ///< how uncertain it is; empty: not known
  TrackState state = TrackState::lost;
  bool has_exposure = false;  ///< false: a bare pose, as poses.csv has them
  glm::dvec3 exposure{1.0};   ///< exposed linear value of white paper on the tag, per unit of albedo (docs/conventions.md)
  glm::dvec3 black{0.0};
  double corner_sigma_px = 0;  ///< how uncertain the tag's corners are in the picture, per axis
  double ambiguity = 0;        ///< probability that the other planar pose is the right one
  Covariance2 blur_px2;        ///< the tag's edges, by focus, motion and pixel; 0: not measured
  double noise_codes = 0;      ///< on the tag, in 8-bit codes; 0: not measured
  NoiseModel noise;            ///< the whole footage's, where it was recorded; all 0: not measured
  BlurModel blur;              ///< blur_px2 taken apart
};

}  // namespace catchlight
