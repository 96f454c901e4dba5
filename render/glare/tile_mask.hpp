// Tiles of the glare grid, and the rectangles that they make up.
#pragma once

#include <cstdint>
#include <vector>

#include "catchlight/pixel_rect.hpp"

namespace catchlight::render {

/// Tiles of GLARE_TILE texels that so many texels take.
int tiles_in(int texels);

/// The tiles of a grid, row by row, each marked or not.
struct TileMask {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> marked;  ///< 1 or 0

  /// The mask with all tiles marked that lie within so many tiles of a marked one.
  TileMask grown(int across, int down) const;
  /// Disjoint rectangles, in tiles, that hold all marked ones and no other.
  std::vector<PixelRect> rectangles() const;
  /// Disjoint rectangles of texels that hold the marked tiles and at least so many texels around them; may lie beyond the grid's
  /// edges.
  std::vector<PixelRect> texels_around(int across, int down) const;
};

/// The rectangle around all of these.
PixelRect around(const std::vector<PixelRect>& rectangles);

}  // namespace catchlight::render
