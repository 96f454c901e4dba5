#include "render/glare_blur.hpp"

#include "shaders/interface.h"

namespace catchlight::render {

GlareBlur::GlareBlur(const std::string& shader_folder) : programs_("glare_blur.frag", shader_folder) {}

void GlareBlur::add(const GlTexture& source, const ColorTarget<1>& scratch, const ColorTarget<1>& target,
                    std::span<const float> taps, const PixelRect& texels) const {
  const GLuint program = programs_.with(static_cast<int>(taps.size()));
  glUseProgram(program);
  glProgramUniform1fv(program, 1, static_cast<GLsizei>(taps.size()), taps.data());
  // The second pass reads as far above and below as the taps reach.
  const int radius = static_cast<int>(taps.size()) - 1;
  const PixelRect taller = intersect({texels.x, texels.y - radius, texels.width, texels.height + 2 * radius},
                                     {0, 0, scratch.width(), scratch.height()});
  glProgramUniform2i(program, 0, 1, 0);
  glBindTextureUnit(TEXTURE_SOURCE, source.id());
  draw_over(scratch, taller);
  glProgramUniform2i(program, 0, 0, 1);
  glBindTextureUnit(TEXTURE_SOURCE, scratch.texture().id());
  const AdditiveBlending blending;
  draw_over(target, texels);
}

}  // namespace catchlight::render
