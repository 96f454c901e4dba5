// Pictures made of pictures: differences, and exposure in false colours.
#pragma once

#include <array>
#include <string>

#include "app/window/surface/rgb_picture.hpp"

namespace catchlight::app {

/// Mid grey where both are the same, `gain` times their difference around it.
RgbPicture difference(const RgbPicture& a, const RgbPicture& b, float gain);

/// A colour of the zones, and what it stands for.
struct Zone {
  std::array<unsigned char, 3> rgb;
  std::string meaning;
};

/// From what is crushed over stops around mid grey to what is clipped.
const std::vector<Zone>& exposure_zones();

/// Stops below and above mid grey in false colours: dark ones violet to blue, mid grey grey, bright ones yellow to red; what is
/// clipped white, what is crushed black.
RgbPicture zones(const RgbPicture& picture);

}  // namespace catchlight::app
