// Where on the glare grid anything is bright: tiles of GLARE_TILE texels, so that passes at the grid's own resolution draw only
// what they must.
#pragma once

#include <memory>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/shader_library.hpp"
#include "render/glare/glare_plan.hpp"
#include "render/glare/tile_mask.hpp"
#include "render/passes/glare/glare_target.hpp"

namespace catchlight::render {

class GlareTiles {
 public:
  explicit GlareTiles(ShaderLibrary& shaders) : shaders_(shaders) {}

  /// Finds the tiles under which a pixel of `object` (which holds the frame's pixels of `rect`) is above `threshold` in any
  /// channel; false where there are none. Waits for the GPU.
  bool find(const GlTexture& object, const PixelRect& rect, const GlareGrid& grid, float threshold);

  /// Disjoint rectangles of texels that hold these tiles and at least so many texels around them; may lie beyond the grid's
  /// edges.
  std::vector<PixelRect> grown(int across, int down) const { return bright_.texels_around(across, down); }

 private:
  ShaderLibrary& shaders_;
  FullscreenDraw draw_;
  std::unique_ptr<ColorTarget<1>> found_;
  TileMask bright_;
};

}  // namespace catchlight::render
