#include "render/passes/glare/glare_blur.hpp"

#include <cmath>

#include "shaders/interface.h"

namespace catchlight::render {

GlareBlur::GlareBlur(const std::string& shader_folder) : programs_("glare_blur.frag", shader_folder) {}

void GlareBlur::use(const GlTexture& source, int axis, const std::vector<double>& taps, double weight) const {
  std::vector<float> shares;
  for (const double tap : taps) shares.push_back(static_cast<float>(tap * std::sqrt(weight)));
  const GLuint program = programs_.with(static_cast<int>(taps.size()));
  glUseProgram(program);
  glProgramUniform2i(program, 0, axis == 0 ? 1 : 0, axis == 0 ? 0 : 1);
  glProgramUniform1fv(program, 1, static_cast<GLsizei>(shares.size()), shares.data());
  glBindTextureUnit(TEXTURE_SOURCE, source.id());
}

void GlareBlur::add(const GlTexture& source, const ColorTarget<1>& scratch, const ColorTarget<1>& target,
                    const std::vector<double>& taps, double weight, const PixelRect& texels) const {
  // The second pass reads as far above and below as the taps reach.
  const int radius = static_cast<int>(taps.size()) - 1;
  const PixelRect taller = intersect({texels.x, texels.y - radius, texels.width, texels.height + 2 * radius},
                                     {0, 0, scratch.width(), scratch.height()});
  use(source, 0, taps, weight);
  draw_over(scratch, taller);
  use(scratch.texture(), 1, taps, weight);
  const AdditiveBlending blending;
  draw_over(target, texels);
}

}  // namespace catchlight::render
