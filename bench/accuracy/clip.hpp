// Short footage of a tag whose corners are known, under rising stress.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "tests/support/synthetic_tag.hpp"

namespace catchlight::tracking {

using Corners = std::array<glm::dvec2, 4>;

struct ClipFrame {
  SyntheticFrame picture;
  double time_s = 0;
  RigidTransform camera_from_tag;
  bool judged = true;  ///< false: only leads the methods that follow a tag to the frames that are
};

struct Clip {
  CameraModel camera;
  TagTarget target;
  std::vector<ClipFrame> frames;
};

/// What makes a tag hard to see. The tag turns and drifts by about a pixel a frame.
struct Stress {
  double size_px = 60, tilt_deg = 25;
  double noise_codes = 3, blur_px = 0.7;
  double motion_px = 0;        ///< length of the smear; from frame to frame the tag moves twice that, as at a 180 degree shutter
  double covered_percent = 0;  ///< share covered by a bar across the tag, its end inside
  double bar_linear = 0.02;
  double k1 = 0;         ///< radial distortion of the lens; the tag then lies far off its axis
  double contrast = 20;  ///< light of white over that of black; their geometric mean is 0.2 at most, white 0.6 at most
};

/// A uniform number in [low, high); the same on every platform.
double uniform(std::mt19937& random, double low, double high);

/// A clip of 3 frames of `easy`, 3 between, 8 of `hard`, which are those judged. Lens and picture size are those of `hard`
/// throughout.
Clip stress_clip(const Stress& easy, const Stress& hard, unsigned seed);

/// One still tag under `seeds` different noises.
Clip still_clip(double size_px, double noise_codes, int seeds, unsigned seed);

/// A clip of 48 frames at 24 Hz of a tag of 30 to 60 px that sways, turns and drifts within 15 degrees of frontal; focal length
/// 1000 px.
Clip frontal_clip(unsigned seed);

}  // namespace catchlight::tracking
