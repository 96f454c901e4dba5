#include "render/passes/receiver_pass.hpp"

#include <limits>

#include "render/receiver_light.hpp"

namespace catchlight::render {
namespace {

glm::vec4 as_vec4(const PlaneRect& rect) {
  return {rect.min_m, rect.max_m};
}

}  // namespace

ReceiverPass::ReceiverPass(const Transfer& transfer, ShaderLibrary& shaders)
    : grid_(transfer.grid),
      unshadowed_(transfer.receiver_unshadowed),
      program_(shaders.program({.vertex = "receiver.vert", .fragment = "receiver.frag"})),
      lights_program_(shaders.program(fullscreen("receiver_light.frag"))),
      no_attributes_(make_vertex_array("no attributes")),
      points_("receiver", transfer.receiver, transfer.receiver_direct, transfer.bands * transfer.bands),
      irradiance_(make_texture_2d("receiver irradiance", GL_RGB32F, grid_.columns, grid_.rows, GL_LINEAR)) {}

void ReceiverPass::light_by(const LightTransfer& transfer, const SplitLight& light, const ShadowedLights& lights,
                            const Bounds& box) {
  points_.evaluate(transfer);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, points_.radiance());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(irradiance_.id(), 0, 0, 0, grid_.columns, grid_.rows, GL_RGB, GL_FLOAT, nullptr);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);

  const OpenPlaneLight open = open_plane_light(unshadowed_, light);
  block_ = {};
  block_.min_max_m = glm::vec4(grid_.min_m, grid_.max_m);
  for (int c = 0; c < 3; ++c) {
    // A plane that gets no light of a colour has no shadow in it: NaN asks the shader for 1.
    const double unshadowed = open.rest[c] + open.lights[c];
    block_.one_over_unshadowed[c] =
        unshadowed > 1e-9 ? static_cast<float>(1.0 / unshadowed) : std::numeric_limits<float>::quiet_NaN();
    block_.unshadowed_rest[c] = static_cast<float>(open.rest[c]);
    block_.unshadowed_lights[c] = static_cast<float>(open.lights[c]);
  }
  block_.points = glm::ivec4(grid_.columns, grid_.rows, 0, 0);
  reach_ = {grid_.min_m, grid_.max_m};
  const PlaneRect of_shadows = shadow_reach(light.samples, open, box);
  if (!of_shadows.empty()) draw_lights(of_shadows, lights, box);
  block_.drawn_min_max_m = as_vec4(reach_);
  uniforms_.update(block_);
}

void ReceiverPass::draw_lights(const PlaneRect& rect, const ShadowedLights& lights, const Bounds& box) {
  const auto [widened, size] = receiver_texels(rect, box);
  block_.lights_min_max_m = as_vec4(widened);
  block_.light_texels = glm::vec4(size, 0, 0);
  uniforms_.update(block_);
  reach_ = unite(reach_, widened);
  if (!light_ || light_->width() != size.x || light_->height() != size.y)
    light_ = std::make_unique<ColorTarget<1>>("lights on the receiver", GL_RGBA32F, size.x, size.y, GL_LINEAR);
  uniforms_.bind(BINDING_RECEIVER);
  lights.bind();
  draw_.over({0, 0, size.x, size.y}, light_->framebuffer(), lights_program_);
}

void ReceiverPass::bind() const {
  glBindTextureUnit(TEXTURE_RATIO, irradiance_.id());
  glBindTextureUnit(TEXTURE_RECEIVER_LIGHT, light_ ? light_->texture().id() : 0);
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
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * (RECEIVER_CELLS + 1), RECEIVER_CELLS);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

}  // namespace catchlight::render
