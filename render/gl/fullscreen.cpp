#include "render/gl/fullscreen.hpp"

#include "shaders/interface.h"

namespace catchlight::render {
namespace {

constexpr int kTriangle = 3;  ///< vertices of the triangle for which fullscreen.vert needs no corners

void upload(GLuint buffer, const std::vector<glm::vec2>& corners) {
  glNamedBufferData(buffer, static_cast<GLsizeiptr>(corners.size() * sizeof(glm::vec2)), corners.data(), GL_STREAM_DRAW);
}

void draw(GLuint framebuffer, const Program& program, Blending blending, int first_vertex, int vertices) {
  reset_state();
  if (blending == Blending::add) {
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glUseProgram(program.id());
  glDrawArrays(GL_TRIANGLES, first_vertex, vertices);
  glDisable(GL_BLEND);
}

}  // namespace

ProgramSource fullscreen(std::string fragment, std::vector<std::string> defines) {
  return {.vertex = "fullscreen.vert", .fragment = std::move(fragment), .defines = std::move(defines)};
}

ProgramSource fullscreen_with_taps(std::string fragment, int count, std::vector<std::string> defines) {
  defines.push_back("TAPS " + std::to_string(count));
  return fullscreen(std::move(fragment), std::move(defines));
}

FullscreenDraw::FullscreenDraw() : vertex_array_(make_vertex_array("rectangles")) {
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  corners_ = GlBuffer(buffer);
  upload(buffer, std::vector<glm::vec2>(kTriangle));
  glVertexArrayVertexBuffer(vertex_array_.id(), 0, buffer, 0, sizeof(glm::vec2));
  glVertexArrayAttribFormat(vertex_array_.id(), ATTRIBUTE_POSITION, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(vertex_array_.id(), ATTRIBUTE_POSITION, 0);
  glEnableVertexArrayAttrib(vertex_array_.id(), ATTRIBUTE_POSITION);
}

void FullscreenDraw::over(const PixelRect& texels, GLuint framebuffer, const Program& program, Blending blending) const {
  if (texels.empty()) return;
  glBindVertexArray(vertex_array_.id());
  glViewport(texels.x, texels.y, texels.width, texels.height);
  draw(framebuffer, program, blending, 0, kTriangle);
}

void FullscreenDraw::over(const std::vector<PixelRect>& rectangles, const ColorTarget<1>& target, const Program& program,
                          Blending blending) const {
  std::vector<glm::vec2> corners(kTriangle);
  const glm::vec2 size(target.width(), target.height());
  for (const PixelRect& r : rectangles) {
    const glm::vec2 low = 2.0f * glm::vec2(r.x, r.y) / size - 1.0f,
                    high = 2.0f * glm::vec2(r.x + r.width, r.y + r.height) / size - 1.0f, right(high.x, low.y),
                    above(low.x, high.y);
    corners.insert(corners.end(), {low, right, above, above, right, high});
  }
  upload(corners_.id(), corners);
  glBindVertexArray(vertex_array_.id());
  glViewport(0, 0, target.width(), target.height());
  draw(target.framebuffer(), program, blending, kTriangle, static_cast<int>(corners.size()) - kTriangle);
}

}  // namespace catchlight::render
