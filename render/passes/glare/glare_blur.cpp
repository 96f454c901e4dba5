#include "render/passes/glare/glare_blur.hpp"

#include <cmath>

#include "shaders/interface.h"

namespace catchlight::render {

const Program& GlareBlur::axis(const GlTexture& source, int axis, const std::vector<double>& taps, double weight) {
  std::vector<float> shares;
  for (const double tap : taps) shares.push_back(static_cast<float>(tap * std::sqrt(weight)));
  Program& program = shaders_.program(fullscreen_with_taps("glare_blur.frag", static_cast<int>(taps.size())));
  program.set("axis", axis == 0 ? glm::ivec2(1, 0) : glm::ivec2(0, 1));
  program.set("taps", shares);
  glBindTextureUnit(TEXTURE_SOURCE, source.id());
  return program;
}

void GlareBlur::add(const GlTexture& source, const ColorTarget<1>& scratch, const ColorTarget<1>& target,
                    const std::vector<double>& taps, double weight, const PixelRect& texels) {
  // The second pass reads as far above and below as the taps reach.
  const int radius = static_cast<int>(taps.size()) - 1;
  const PixelRect taller = intersect({texels.x, texels.y - radius, texels.width, texels.height + 2 * radius},
                                     {0, 0, scratch.width(), scratch.height()});
  draw_.over(taller, scratch.framebuffer(), axis(source, 0, taps, weight));
  draw_.over(texels, target.framebuffer(), axis(scratch.texture(), 1, taps, weight), Blending::add);
}

}  // namespace catchlight::render
