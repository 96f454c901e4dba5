// Renders AprilTags whose corners are known exactly, sharing no projection, lens or pattern code with the product:
// rays are met with the tag's plane, the lens is inverted by OpenCV, the print comes from the library's own drawing.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"

namespace catchlight::tracking {

struct SyntheticTag {
  TagTarget target;
  RigidTransform camera_from_tag;
};

struct SyntheticScene {
  CameraModel camera;
  std::vector<SyntheticTag> tags;  ///< later ones lie on top
  double white_linear = 0.6, black_linear = 0.03, background_linear = 0.25;
  double paper_margin_cells = 1;  ///< white paper around the print
  double blur_px = 0.6;           ///< standard deviation of the lens's Gaussian, before the pixel's own square
  double noise_codes = 0;         ///< standard deviation of the sensor's noise in 8-bit codes
  unsigned seed = 1;
};

/// One channel, row-major.
struct SyntheticFrame {
  int width_px = 0, height_px = 0;
  std::vector<float> linear;        ///< blurred light, without noise or clipping
  std::vector<std::uint8_t> codes;  ///< sRGB, full range, with noise

  LumaView luma() const { return {codes.data(), width_px, height_px, width_px}; }
};

/// 8x8 rays a pixel around the tags.
SyntheticFrame render(const SyntheticScene& scene);

/// sRGB codes of `linear` with Gaussian noise; done by render() too.
std::vector<std::uint8_t> expose(const std::vector<float>& linear, double noise_codes, unsigned seed);

/// A tag facing the camera at `distance_m`, then turned about the camera's x, y and z axes (degrees), its centre at
/// `center_px`.
RigidTransform tag_pose(const CameraModel& camera, const glm::dvec2& center_px, double distance_m, const glm::dvec3& turn_deg);

/// Exact corners as seen, in the order of TagObservation::corners_px, through cv::projectPoints.
std::array<glm::dvec2, 4> true_corners_px(const CameraModel& camera, const SyntheticTag& tag);

/// 640x480, 600 px focal length, no distortion.
CameraModel plain_camera();

/// The same with the barrel distortion and slight decentring of a cheap wide lens (rational model, all eight terms).
CameraModel distorted_camera();

double rms_distance(const std::array<glm::dvec2, 4>& a, const std::array<glm::dvec2, 4>& b);

/// Mean movement of `found` away from the centre of `truth`: negative where corners lie too far inside.
double outward_bias_px(const std::array<glm::dvec2, 4>& found, const std::array<glm::dvec2, 4>& truth);

}  // namespace catchlight::tracking
