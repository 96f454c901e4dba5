#include "render/glare/tile_mask.hpp"

#include <algorithm>

#include "shaders/interface.h"

namespace catchlight::render {

int tiles_in(int texels) {
  return (texels + GLARE_TILE - 1) / GLARE_TILE;
}

TileMask TileMask::grown(int across, int down) const {
  // What is marked at least once within the window, one axis after the other: counts that move along.
  const auto grow = [](const TileMask& from, int count, int lines, int along, int line_step, int reach) {
    TileMask to = from;
    for (int line = 0; line < lines; ++line) {
      const auto at = [&](int i) { return static_cast<std::size_t>(line * line_step + i * along); };
      int inside = 0;
      for (int i = 0; i < std::min(reach, count); ++i) inside += from.marked[at(i)];
      for (int i = 0; i < count; ++i) {
        if (i + reach < count) inside += from.marked[at(i + reach)];
        to.marked[at(i)] = inside > 0 ? 1 : 0;
        if (i - reach >= 0) inside -= from.marked[at(i - reach)];
      }
    }
    return to;
  };
  return grow(grow(*this, columns, rows, 1, columns, across), rows, columns, columns, 1, down);
}

std::vector<PixelRect> TileMask::rectangles() const {
  std::vector<PixelRect> all, open;  // those that end in the row above may go on
  for (int y = 0; y < rows; ++y) {
    std::vector<PixelRect> here;
    auto above = open.begin();
    const auto row = marked.begin() + static_cast<std::ptrdiff_t>(y) * columns, end = row + columns;
    for (auto from = std::find(row, end, 1); from != end;) {
      const auto to = std::find(from, end, 0);
      PixelRect run{static_cast<int>(from - row), y, static_cast<int>(to - from), 1};
      while (above != open.end() && above->x < run.x) all.push_back(*above++);
      if (above != open.end() && above->x == run.x && above->width == run.width) {
        run.y = above->y, run.height = above->height + 1;
        ++above;
      }
      here.push_back(run);
      from = std::find(to, end, 1);
    }
    all.insert(all.end(), above, open.end());
    open = std::move(here);
  }
  all.insert(all.end(), open.begin(), open.end());
  return all;
}

std::vector<PixelRect> TileMask::texels_around(int across, int down) const {
  std::vector<PixelRect> all = grown(tiles_in(across), tiles_in(down)).rectangles();
  for (PixelRect& r : all) r = {GLARE_TILE * r.x, GLARE_TILE * r.y, GLARE_TILE * r.width, GLARE_TILE * r.height};
  return all;
}

PixelRect around(const std::vector<PixelRect>& rectangles) {
  PixelRect all;
  for (const PixelRect& each : rectangles) all = unite(all, each);
  return all;
}

}  // namespace catchlight::render
