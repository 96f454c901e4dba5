// What tracking finds in one frame.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"

namespace catchlight::tracking {

/// A pose that one frame allows.
struct PoseCandidate {
  RigidTransform camera_from_tag;
  PoseCovariance covariance{};
  double log_likelihood = 0;  ///< comparable among the candidates of one frame
};

/// What the camera made of the tag's print, from direct refinement.
struct TagAppearance {
  double white_linear = 0, black_linear = 0;  ///< luma made linear, in the tag's middle; 1 = sensor white
  Covariance2 blur_px2;                       ///< by lens, motion and pixel together
  double noise_codes = 0;                     ///< standard deviation, 8-bit codes
  double occluded_share = 0;                  ///< share of the tag that something else hides
};

/// One frame's result. Corners are in tag order (-,-) (+,-) (+,+) (-,+), in OpenCV's pixel convention, as seen (distorted).
struct TagObservation {
  TrackState state = TrackState::lost;
  RigidTransform camera_from_tag;
  PoseCovariance covariance{};
  std::array<glm::dvec2, 4> corners_px{};   ///< the first tag's
  double corner_sigma_px = 0;               ///< how uncertain they are, per axis
  double ambiguity = 0;                     ///< probability that the other planar pose is the right one
  std::vector<PoseCandidate> candidates;    ///< one or two, the likelier first; empty unless tracking
  std::optional<TagAppearance> appearance;  ///< where the frame was refined directly
};

}  // namespace catchlight::tracking
