#include "render/gl/point_capture.hpp"

namespace catchlight::render {

PointCapture::PointCapture(const std::string& vertex_shader, std::vector<std::string> outputs, std::size_t point_bytes,
                           ShaderLibrary& shaders)
    : program_(shaders.program({.vertex = vertex_shader, .captured = std::move(outputs)})),
      point_bytes_(static_cast<GLsizeiptr>(point_bytes)),
      no_attributes_(make_vertex_array("no attributes")),
      no_pixels_(make_framebuffer("no pixels")) {
  glNamedFramebufferParameteri(no_pixels_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
  glNamedFramebufferParameteri(no_pixels_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
}

void PointCapture::run(GLuint target, GLintptr offset, int points) const {
  glBindFramebuffer(GL_FRAMEBUFFER, no_pixels_.id());
  glUseProgram(program_.id());
  glBindVertexArray(no_attributes_.id());
  glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, target, offset, points * point_bytes_);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, points);
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
}

}  // namespace catchlight::render
