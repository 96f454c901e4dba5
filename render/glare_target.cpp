#include "render/glare_target.hpp"

namespace catchlight::render {

ColorTarget<1> make_glare_target(const char* label, int width, int height) {
  ColorTarget<1> target(label, GL_RGBA32F, width, height, GL_LINEAR);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  return target;
}

void clear(const ColorTarget<1>& target) {
  const float zero[4] = {0, 0, 0, 0};
  glDisable(GL_SCISSOR_TEST);
  glClearNamedFramebufferfv(target.framebuffer(), GL_COLOR, 0, zero);
}

void draw_over(const ColorTarget<1>& target, const PixelRect& texels) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  glViewport(0, 0, target.width(), target.height());
  glEnable(GL_SCISSOR_TEST);
  glScissor(texels.x, texels.y, texels.width, texels.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

AdditiveBlending::AdditiveBlending() {
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
}

AdditiveBlending::~AdditiveBlending() {
  glDisable(GL_BLEND);
}

}  // namespace catchlight::render
