// What tests of tracking and exposure share: a camera that is quick to render, and footage exposed anew.
#pragma once

#include <algorithm>
#include <cmath>

#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/plate.hpp"
#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {

/// A long lens: the tag of 8 cm is 61 px large at 1.3 m.
inline CameraModel small_camera() {
  return {200, 160, 1000, 1000, 99.5, 79.5, {}};
}

inline SceneSettings scene_of_tag_5() {
  SceneSettings scene;
  scene.tag.id = 5;
  return scene;
}

/// The light of a frame of 8-bit sRGB times `gain`, clipped at the sensor's white, in 8 bits again.
inline Frame reexposed(const Frame& frame, const glm::dvec3& gain) {
  const int width = frame.width_px(), height = frame.height_px();
  const Plate plate = frame.rgb({0, 0, width, height});
  FramePtr picture = noise_frame(AV_PIX_FMT_RGB24, width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 3 * width; ++x) {
      const auto code = static_cast<double>(plate.pixels[static_cast<std::size_t>(3 * width * y + x)]);
      const double light = std::min(linear_from_srgb(code / 255) * gain[x % 3], 1.0);
      picture->data[0][y * picture->linesize[0] + x] = static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(light)));
    }
  return {std::shared_ptr<const AVFrame>(std::move(picture)), frame.number(), frame.time_s()};
}

}  // namespace catchlight::app::testing
