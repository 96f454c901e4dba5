// The arithmetic of compositing on a few pixels of a row at once, a plane a channel, as vector units want it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "render/camera_effects.hpp"

namespace catchlight::render {

/// So many that all that is known of them stays in the nearest cache.
inline constexpr int kBlockPixels = 128;

using Plane = std::array<float, kBlockPixels>;
using Planes = std::array<Plane, 3>;  ///< red, green, blue
using PixelMask = std::array<std::int32_t, kBlockPixels>;

/// What of the plate every pixel has in common: exposed linear light.
struct PlateLevels {
  glm::vec3 black{0};           ///< light that the lens scatters
  glm::vec3 receiver_light{0};  ///< the receiver's, where the plate is clipped
  bool clips = false;           ///< codes end at 0 and 1
  float changed_code = 0;       ///< the smallest difference of codes that counts
};

/// `count` pixels of the frame from (x, y) on to the right.
struct PlateBlock {
  int x = 0, y = 0, count = 0;
  Planes code, background;       ///< the plate's, and its light
  Planes ratio, object, glare;   ///< what is put into it; the object's light is premultiplied
  Plane coverage;                ///< by the object
  PixelMask is_touched;          ///< something virtual is there to be seen
  PixelMask lacks_noise;         ///< so much of it that the plate's own noise does not do
  Planes shadowed, over, light;  ///< the plate in shadow, the object with the black in front of it, and all of it together
  Planes result;                 ///< codes
  PixelMask is_changed;          ///< codes that differ from the plate's
};

/// Finds what is touched, and takes away a shadow and a glare that nobody sees. True where anything is touched.
bool find_touched(PlateBlock& block);

/// Debevec's (1998) sum: shadowed, over, light.
void composite_light(const PlateLevels& levels, PlateBlock& block);

/// Adds the noise (shading::missing_sigma()) that the plate has lost, where much of it is lost.
void add_missing_noise(const SensorNoise& noise, PlateBlock& block);

/// Bounds the result's codes, and finds those that differ from the plate's. What is not touched keeps the plate's.
void find_changed(const PlateLevels& levels, PlateBlock& block);

}  // namespace catchlight::render
