// Pictures of bright things, in exposed linear light: made on the CPU, so that glare can be measured without drawing an object.
#pragma once

#include <string>
#include <vector>

#include "catchlight/image.hpp"

namespace catchlight::render::test {

/// One pixel (or part of up to four: the highlight covers a square of one pixel whose corner is at x, y) on black.
Image one_pixel_highlight(int width, int height, double x, double y, float radiance);

/// A mirror ball that a small sun and a room of windows are reflected in.
Image mirror_ball(int width, int height);

/// A glossy bar across the picture with the highlights of three windows, softened by its roughness.
Image glossy_bar(int width, int height);

/// Many small lamps of different colours, 2 to 20000 times the sensor's white.
Image lamps(int width, int height);

struct NamedScene {
  std::string name;
  Image (*make)(int width, int height);
};
std::vector<NamedScene> glare_scenes();

}  // namespace catchlight::render::test
