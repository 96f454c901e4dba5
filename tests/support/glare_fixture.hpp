// Runs the glare passes on a picture that stands for the drawn object.
#pragma once

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/passes/glare/glare_pass.hpp"
#include "tests/support/gl_fixture.hpp"

namespace catchlight::render::test {

/// An RGB picture as the texture of a drawn object.
GlTexture upload(const Image& rgb);

struct Glared {
  bool any;
  PixelRect reach;
  GlareGrid grid;
  Image excess, glare;  ///< on the grid; empty where there is none
};

/// `picture`: exposed linear RGB of the whole frame. `emission`: what of it the object emits; null for nothing said.
Glared glared(GlarePass& pass, const Image& picture, const Image* emission = nullptr);
Glared glared(const GlareSettings& settings, const Image& picture, const Image* emission = nullptr);

/// The sum of a channel over all texels.
double sum_of(const Image& image, int channel = 0);

}  // namespace catchlight::render::test
