// A picture's codes, column by column.
#pragma once

#include <array>
#include <vector>

#include "app/window/surface/rgb_picture.hpp"

namespace catchlight::app {

/// How often each 8-bit code is in each part of the picture's width: red, green, blue, and luma of them.
struct Waveform {
  int columns = 0;
  std::array<std::vector<int>, 4> counts;  ///< columns a code, code 0 first
  int at(std::size_t channel, int code, int column) const {
    return counts[channel][static_cast<std::size_t>(code) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

/// Large pictures are counted by some of their rows.
Waveform waveform_of(const RgbPicture& picture, int columns);

/// Luma from edge to edge, code 255 on top; the more often a code, the brighter.
RgbPicture luma_waveform(const Waveform& waveform);

/// Red, green and blue side by side, in their colours.
RgbPicture rgb_parade(const Waveform& waveform);

}  // namespace catchlight::app
