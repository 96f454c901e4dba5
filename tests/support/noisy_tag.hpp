// A tag in rendered frames whose light, noise and blur are known.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "app/media/pixels/frame.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tests/support/media_fixture.hpp"
#include "tests/support/synthetic_tag.hpp"

namespace catchlight::app::noisy_tag {

using testing::noise_frame;
using tracking::SyntheticScene;

inline CameraModel camera() {
  return {320, 240, 600, 600, 159.5, 119.5, {}};
}

inline TagTarget target() {
  return {{"tag36h11", 5, 0.08}, {}};
}

/// The tag some 160 px large.
inline SyntheticScene scene() {
  SyntheticScene scene{camera(), {}};
  scene.tags = {{target(), tracking::tag_pose(camera(), {160, 120}, 0.3, {20, 15, 10})}};
  return scene;
}

inline TrackRow row_of(const SyntheticScene& scene) {
  TrackRow row;
  row.found = true;
  row.state = TrackState::tracking;
  row.camera_from_tag = scene.tags[0].camera_from_tag;
  row.blur_px2 = {0.5, 0, 0.5};
  row.noise_codes = 1;
  return row;
}

/// RGB of a grey scene with independent noise of that variance in each channel.
inline Frame noisy_frame(const SyntheticScene& scene, const glm::dvec3& slope, double floor, unsigned seed) {
  const std::vector<float> light = tracking::render(scene).linear;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  FramePtr picture = noise_frame(AV_PIX_FMT_RGB24, 320, 240, 1);
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      for (int c = 0; c < 3; ++c) {
        const double i = light[static_cast<std::size_t>(y * 320 + x)];
        const double code = srgb_from_linear(i + std::sqrt(slope[c] * i + floor) * normal(random));
        picture->data[0][y * picture->linesize[0] + 3 * x + c] =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(code, 0.0, 1.0)));
      }
  return {std::shared_ptr<const AVFrame>(std::move(picture)), static_cast<std::int64_t>(seed), 0};
}

}  // namespace catchlight::app::noisy_tag
