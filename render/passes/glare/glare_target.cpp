#include "render/passes/glare/glare_target.hpp"

#include <glm/glm.hpp>

#include "shaders/interface.h"

namespace catchlight::render {

ColorTarget<1> make_glare_target(const char* label, int width, int height) {
  ColorTarget<1> target(label, GL_RGBA32F, width, height, GL_LINEAR);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  return target;
}

void clear(const ColorTarget<1>& target) {
  clear(target, {0, 0, target.width(), target.height()});
}

void clear(const ColorTarget<1>& target, const PixelRect& texels) {
  const float zero[4] = {0, 0, 0, 0};
  glEnable(GL_SCISSOR_TEST);
  glScissor(texels.x, texels.y, texels.width, texels.height);
  glClearNamedFramebufferfv(target.framebuffer(), GL_COLOR, 0, zero);
}

void draw_over(const ColorTarget<1>& target, const PixelRect& texels) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  glViewport(0, 0, target.width(), target.height());
  glEnable(GL_SCISSOR_TEST);
  glScissor(texels.x, texels.y, texels.width, texels.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

RectangleArray::RectangleArray() : vertex_array_(make_vertex_array("rectangles")) {
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  corners_ = GlBuffer(buffer);
  glVertexArrayVertexBuffer(vertex_array_.id(), 0, buffer, 0, sizeof(glm::vec2));
  glVertexArrayAttribFormat(vertex_array_.id(), ATTRIBUTE_POSITION, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(vertex_array_.id(), ATTRIBUTE_POSITION, 0);
  glEnableVertexArrayAttrib(vertex_array_.id(), ATTRIBUTE_POSITION);
}

void RectangleArray::draw(const ColorTarget<1>& target, const std::vector<PixelRect>& rectangles) const {
  constexpr int kFirst = 3;  // fullscreen.vert has its triangle before
  std::vector<glm::vec2> corners(kFirst);
  const glm::vec2 size(target.width(), target.height());
  for (const PixelRect& r : rectangles) {
    const glm::vec2 low = 2.0f * glm::vec2(r.x, r.y) / size - 1.0f,
                    high = 2.0f * glm::vec2(r.x + r.width, r.y + r.height) / size - 1.0f, right(high.x, low.y),
                    above(low.x, high.y);
    corners.insert(corners.end(), {low, right, above, above, right, high});
  }
  glNamedBufferData(corners_.id(), static_cast<GLsizeiptr>(corners.size() * sizeof(glm::vec2)), corners.data(), GL_STREAM_DRAW);
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  glViewport(0, 0, target.width(), target.height());
  glDisable(GL_SCISSOR_TEST);
  glDrawArrays(GL_TRIANGLES, kFirst, static_cast<GLsizei>(corners.size()) - kFirst);
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
