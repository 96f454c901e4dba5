// The tables that reflections are looked up in, as textures.
#pragma once

#include "render/gl/gl_objects.hpp"
#include "render/probe/prefilter.hpp"

namespace catchlight::render {

/// Cube map whose mip levels are the map's roughness levels, filtered between texels, faces and levels. A level whose faces are
/// not half as large as the one's before is resampled. No levels: black. Throws Error as check_cubes() does.
GlTexture make_reflection_texture(const ReflectionMap& reflections);

/// Scale and bias of F0 by (n.v, perceptual roughness).
GlTexture make_brdf_texture();

}  // namespace catchlight::render
