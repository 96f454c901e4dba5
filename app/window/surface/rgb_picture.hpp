// A picture as screens show it.
#pragma once

#include <vector>

namespace catchlight::app {

/// 8-bit RGB, rows from the top.
struct RgbPicture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
};

}  // namespace catchlight::app
