#include "render/light_transfer.hpp"

#include <algorithm>

#include "catchlight.hpp"
#include "render/shader.hpp"

namespace catchlight::render {

LightTransfer::LightTransfer(const std::string& shader_folder)
    : program_(make_program({.vertex = "transfer.vert", .fragment = {}, .captured = {"transferred"}}, shader_folder)),
      no_attributes_(make_vertex_array("no attributes")),
      no_pixels_(make_framebuffer("no pixels")) {
  glNamedFramebufferParameteri(no_pixels_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
  glNamedFramebufferParameteri(no_pixels_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
}

void LightTransfer::set_light(const ShRgb& light_linear) {
  coefficients_ = static_cast<int>(std::min<std::size_t>(light_linear.size(), MAX_LIGHT_COEFFICIENTS));
  shader_interface::LightUniforms block{};
  block.count.x = coefficients_;
  for (int i = 0; i < coefficients_; ++i) block.coefficients[i] = glm::vec4(light_linear[static_cast<std::size_t>(i)], 0.0f);
  uniforms_.update(block);
}

void LightTransfer::capture(GLuint target, GLintptr offset, int points) const {
  constexpr GLsizeiptr kPointBytes = sizeof(glm::vec3);
  glBindFramebuffer(GL_FRAMEBUFFER, no_pixels_.id());
  uniforms_.bind(BINDING_LIGHT);
  glUseProgram(program_.id());
  glBindVertexArray(no_attributes_.id());
  glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, target, offset, points * kPointBytes);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, points);
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
}

LitPoints::LitPoints(const std::string& label, std::span<const glm::vec3> transfer, int coefficients)
    : count_(static_cast<int>(transfer.size() / static_cast<std::size_t>(coefficients))),
      transfer_(make_buffer(label + " transfer", transfer)),
      radiance_(make_buffer(label + " radiance", static_cast<std::size_t>(count_) * sizeof(glm::vec3), nullptr)) {}

void LitPoints::evaluate(const LightTransfer& light) {
  // A storage block's size is limited (128 MiB in Mesa) and its offset aligned (256 bytes at most): 64 points of 12-byte values
  // keep to both.
  constexpr GLsizeiptr kAlignedPoints = 64, kValueBytes = sizeof(glm::vec3);
  GLint limit = 0;
  glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limit);
  const GLsizeiptr point_bytes = light.coefficients() * kValueBytes;
  const auto chunk = static_cast<int>(std::max<GLsizeiptr>(limit / (kAlignedPoints * point_bytes), 1) * kAlignedPoints);
  for (int first = 0; first < count_; first += chunk) {
    const int points = std::min(chunk, count_ - first);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, BINDING_TRANSFER, transfer_.id(), first * point_bytes, points * point_bytes);
    light.capture(radiance_.id(), first * kValueBytes, points);
  }
}

}  // namespace catchlight::render
