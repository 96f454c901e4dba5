// What both renderers share of the layers for compositing packages.
#pragma once

#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"

namespace catchlight::render {

/// Layers of the whole frame without any object in them.
Layers empty_layers(const PixelRect& frame);

/// Less coverage than this is none: it rounds to 0 in the halves of a file.
inline constexpr float kMinCoverage = 0x1.000002p-25f;

/// Puts normals and depth into those pixels of the layers that have none yet. `normal_depth` holds the frame's pixels of `rect`,
/// premultiplied by the coverage, which is the last channel of `color`: what becomes of them is the mean over what covers the
/// pixel, and normals have length 1. Called with the sharp object, then with the blurred one, it keeps the sharp object's data
/// sharp, and gives what only the blur reaches the data of what is blurred into it.
void add_geometry(const Image& color, const Image& normal_depth, const PixelRect& rect, Layers& layers);

}  // namespace catchlight::render
