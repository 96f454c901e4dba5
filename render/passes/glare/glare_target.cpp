#include "render/passes/glare/glare_target.hpp"

namespace catchlight::render {

ColorTarget<1> make_glare_target(const char* label, int width, int height) {
  ColorTarget<1> target(label, GL_RGBA32F, width, height, GL_LINEAR);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  return target;
}

void clear(const ColorTarget<1>& target) {
  const float zero[4] = {0, 0, 0, 0};
  reset_state();
  glClearNamedFramebufferfv(target.framebuffer(), GL_COLOR, 0, zero);
}

}  // namespace catchlight::render
