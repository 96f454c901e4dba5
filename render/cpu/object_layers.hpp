// The layers for compositing packages that only the object's pass knows.
#pragma once

#include "catchlight/composite.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/cpu/cpu_object.hpp"

namespace catchlight::render {

/// Layers of the whole frame without any object in them.
Layers empty_layers(const PixelRect& frame);

/// Puts reflection, normals and depth into the layers: normals of length 1 and the mean depth of what covers the pixel.
void put_object_layers(const ObjectImages& images, Layers& layers);

}  // namespace catchlight::render
