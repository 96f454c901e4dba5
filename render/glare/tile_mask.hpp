// Tiles of the glare grid, and the rectangles that they make up.
#pragma once

#include <cstdint>
#include <vector>

#include "catchlight/pixel_rect.hpp"

namespace catchlight::render {

/// A mask has the tiles of a grid, row by row.
struct TileMask {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> marked;  ///< 1 or 0

  /// With all tiles that lie within so many tiles of one.
  TileMask grown(int across, int down) const;
  /// Disjoint rectangles, in tiles, of all that are marked.
  std::vector<PixelRect> rectangles() const;
};

}  // namespace catchlight::render
