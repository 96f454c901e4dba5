#include "render/passes/light_transfer.hpp"

#include <algorithm>

namespace catchlight::render {

void LightTransfer::set_light(const ShRgb& light_linear, const ShRgb& split_off) {
  coefficients_ = static_cast<int>(std::min<std::size_t>(light_linear.size(), MAX_LIGHT_COEFFICIENTS));
  shader_interface::LightUniforms block{};
  block.count.x = coefficients_;
  block.count.y = split_off.empty() ? 0 : 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(coefficients_); ++i) {
    block.coefficients[i] = glm::vec4(light_linear[i], 0.0f);
    if (!split_off.empty()) block.split_off[i] = glm::vec4(split_off[i], 0.0f);
  }
  uniforms_.update(block);
}

void LightTransfer::capture(GLuint target, GLintptr offset, int points) const {
  uniforms_.bind(BINDING_LIGHT);
  capture_.run(target, offset, points);
}

LitPoints::LitPoints(const std::string& label, std::span<const glm::vec3> transfer, std::span<const glm::vec3> direct,
                     int coefficients)
    : count_(static_cast<int>(transfer.size() / static_cast<std::size_t>(coefficients))),
      has_direct_(!direct.empty()),
      transfer_(make_buffer(label + " transfer", transfer)),
      direct_(make_buffer(label + " direct transfer", direct)),
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
    // The shader always has it bound, and reads it only for a light that was split.
    const GlBuffer& direct = has_direct_ ? direct_ : transfer_;
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, BINDING_DIRECT_TRANSFER, direct.id(), first * point_bytes, points * point_bytes);
    light.capture(radiance_.id(), first * kValueBytes, points);
  }
}

}  // namespace catchlight::render
