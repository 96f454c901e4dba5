// The layers that only the object pass knows.
#pragma once

#include "catchlight/composite.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/gl/render_target.hpp"

namespace catchlight::render {

/// Fills reflection, normal and depth of the whole frame from `target`, which holds the frame's pixels of `rect` (may be empty).
/// Normals have length 1, and 0 where no object is; depth is the mean over the covered part of a pixel, and infinite where no
/// object is.
void read_object_layers(const ObjectTarget* target, const PixelRect& rect, const PixelRect& frame, Layers& layers);

}  // namespace catchlight::render
