// Runs the glare passes on a picture that stands for the drawn object.
#pragma once

#include "render/glare.hpp"
#include "tests/render/gl_fixture.hpp"

namespace catchlight::render::test {

struct Glared {
  bool any;
  PixelRect reach;
  GlareGrid grid;
  Image excess, glare;  ///< on the grid; empty where there is none
};

/// `picture`: exposed linear RGB of the whole frame. `emission`: what of it the object emits; null for nothing said.
Glared glared(GlarePass& pass, const Image& picture, const Image* emission = nullptr);
Glared glared(const GlareSettings& settings, const Image& picture, const Image* emission = nullptr);

/// The least time of so many runs on the same picture, until the GPU is done.
double least_glare_ms(GlarePass& pass, const Image& picture, int runs);

/// Over all texels.
double sum_of(const Image& image, int channel = 0);

}  // namespace catchlight::render::test
