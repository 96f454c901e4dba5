#include "render/passes/glare/glare_tiles.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/interface.h"

namespace catchlight::render {
bool GlareTiles::find(const GlTexture& object, const PixelRect& rect, const GlareGrid& grid, float threshold) {
  const int columns = tiles_in(grid.columns), rows = tiles_in(grid.rows);
  if (!found_ || found_->width() != columns || found_->height() != rows)
    found_ = std::make_unique<ColorTarget<1>>("bright tiles", GL_R8, columns, rows);
  clear(*found_);
  const int pixels_along_tile = static_cast<int>(std::ceil(GLARE_TILE * grid.texel_px));
  Program& program = shaders_.program(fullscreen_with_taps("glare_tiles.frag", pixels_along_tile));
  program.set("first_pixel", glm::ivec2(rect.x, rect.y));
  program.set("source_size", glm::ivec2(rect.width, rect.height));
  program.set("texel_px", static_cast<float>(grid.texel_px));
  program.set("threshold", threshold);
  glBindTextureUnit(TEXTURE_SOURCE, object.id());
  const PixelRect texels = grid.texels(rect, 0);
  const int x = texels.x / GLARE_TILE, y = texels.y / GLARE_TILE;
  draw_.over({x, y, tiles_in(texels.x + texels.width) - x, tiles_in(texels.y + texels.height) - y}, found_->framebuffer(),
             program);
  bright_ = {columns, rows, std::vector<std::uint8_t>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))};
  glBindFramebuffer(GL_READ_FRAMEBUFFER, found_->framebuffer());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, columns, rows, GL_RED, GL_UNSIGNED_BYTE, bright_.marked.data());
  for (std::uint8_t& mark : bright_.marked) mark = mark != 0 ? 1 : 0;
  return std::find(bright_.marked.begin(), bright_.marked.end(), 1) != bright_.marked.end();
}

}  // namespace catchlight::render
