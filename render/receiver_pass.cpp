#include "render/receiver_pass.hpp"

#include <algorithm>

#include "render/shader.hpp"

namespace catchlight::render {

ReceiverPass::ReceiverPass(const Transfer& transfer, const std::string& shader_folder)
    : grid_(transfer.grid),
      unshadowed_(transfer.receiver_unshadowed),
      program_(make_program({.vertex = "receiver.vert", .fragment = "receiver.frag", .captured = {}}, shader_folder)),
      no_attributes_(make_vertex_array("no attributes")),
      points_("receiver", transfer.receiver, transfer.bands * transfer.bands),
      irradiance_(make_texture_2d("receiver irradiance", GL_RGB32F, grid_.columns, grid_.rows, GL_LINEAR)) {}

void ReceiverPass::light_by(const LightTransfer& light, const ShRgb& light_tag) {
  points_.evaluate(light);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, points_.radiance());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(irradiance_.id(), 0, 0, 0, grid_.columns, grid_.rows, GL_RGB, GL_FLOAT, nullptr);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);

  glm::dvec3 unshadowed(0.0);
  for (std::size_t i = 0; i < unshadowed_.size(); ++i)
    unshadowed += glm::dvec3(light_tag[i]) * static_cast<double>(unshadowed_[i]);
  shader_interface::ReceiverUniforms block{};
  block.min_max_m = glm::vec4(grid_.min_m, grid_.max_m);
  for (int c = 0; c < 3; ++c) {
    // A plane that gets no light of a colour has no shadow in it: NaN asks the shader for 1.
    block.one_over_unshadowed[c] =
        unshadowed[c] > 1e-9 ? static_cast<float>(1.0 / unshadowed[c]) : std::numeric_limits<float>::quiet_NaN();
  }
  block.points = glm::ivec4(grid_.columns, grid_.rows, 0, 0);
  uniforms_.update(block);
}

void ReceiverPass::bind() const {
  glBindTextureUnit(TEXTURE_RATIO, irradiance_.id());
  uniforms_.bind(BINDING_RECEIVER);
}

void ReceiverPass::draw(const ColorTarget<1>& target, const PixelRect& rect, int frame_width, int frame_height) const {
  reset_state();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  set_viewport(rect, frame_width, frame_height);
  // Same depth range as the object's, so that what is behind the camera is cut off at the same place.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glUseProgram(program_.id());
  glBindVertexArray(no_attributes_.id());
  bind();
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * grid_.columns, grid_.rows - 1);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

}  // namespace catchlight::render
