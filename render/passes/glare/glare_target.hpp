// What glare's passes draw into: textures of the glare grid and of its halvings, each with a margin of GLARE_MARGIN texels.
#pragma once

#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/gl/render_target.hpp"

namespace catchlight::render {

/// 32 bits a channel: four streak passes would round half floats by up to 1e-3, and the sun's excess does not fit them.
/// Nothing comes in from beyond its edges.
ColorTarget<1> make_glare_target(const char* label, int width, int height);

void clear(const ColorTarget<1>& target);
void clear(const ColorTarget<1>& target, const PixelRect& texels);

/// Draws the current program over these texels of `target`. Needs a vertex array bound.
void draw_over(const ColorTarget<1>& target, const PixelRect& texels);

/// Many rectangles in one draw.
class RectangleArray {
 public:
  RectangleArray();

  /// To be bound before draw(); draw_over() works with it too.
  const GlVertexArray& vertex_array() const { return vertex_array_; }

  /// Draws the current program over these texels of `target`; those that are in several rectangles are drawn several times.
  void draw(const ColorTarget<1>& target, const std::vector<PixelRect>& rectangles) const;

 private:
  GlBuffer corners_;
  GlVertexArray vertex_array_;
};

/// Adds to what is there, until the end of this object's life.
class AdditiveBlending {
 public:
  AdditiveBlending();
  ~AdditiveBlending();
  AdditiveBlending(const AdditiveBlending&) = delete;
  AdditiveBlending& operator=(const AdditiveBlending&) = delete;
};

}  // namespace catchlight::render
