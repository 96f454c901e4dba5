// Tiles of the glare grid, and the rectangles that they make up.
#pragma once

#include <cstdint>
#include <vector>

#include "catchlight/pixel_rect.hpp"

namespace catchlight::render {

/// The tiles of a grid, row by row, each marked or not.
struct TileMask {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> marked;  ///< 1 or 0

  /// The mask with all tiles marked that lie within so many tiles of a marked one.
  TileMask grown(int across, int down) const;
  /// Disjoint rectangles, in tiles, that hold all marked ones and no other.
  std::vector<PixelRect> rectangles() const;
};

}  // namespace catchlight::render
