// The layers that only the object pass knows.
#pragma once

#include "catchlight/composite.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/gl/render_target.hpp"

namespace catchlight::render {

/// Fills reflection, normal and depth of the whole frame from `target`, which holds the frame's pixels of `rect` (empty: zeros).
/// Normals have length 1 and depth is the mean over the covered part of a pixel; both are 0 where there is no object.
void read_object_layers(const ObjectTarget* target, const PixelRect& rect, const PixelRect& frame, Layers& layers);

}  // namespace catchlight::render
