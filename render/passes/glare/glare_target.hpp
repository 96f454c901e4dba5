// What glare's passes draw into: textures of the glare grid and of its halvings, each with a margin of GLARE_MARGIN texels.
#pragma once

#include "render/gl/render_target.hpp"

namespace catchlight::render {

/// A target of 32 bits a channel: four streak passes would round half floats by up to 1e-3, and the sun's excess does not fit
/// them. Nothing comes in from beyond its edges.
ColorTarget<1> make_glare_target(const char* label, int width, int height);

/// Makes all of the target black.
void clear(const ColorTarget<1>& target);

}  // namespace catchlight::render
