#include "render/passes/receiver_pass.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace catchlight::render {
namespace {

constexpr float kFarthestShadow = 16;  ///< distance in sizes of the object
/// Texels of the lights' texture across the object, and at most along a side.
constexpr float kTexelsAcrossObject = 192;
constexpr int kMinTexels = 16, kMaxTexels = 1024;

glm::vec4 as_vec4(const PlaneRect& rect) {
  return {rect.min_m, rect.max_m};
}

glm::dvec3 dot(const std::vector<float>& transfer, const ShRgb& light) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < light.size(); ++i) sum += glm::dvec3(light[i]) * static_cast<double>(transfer[i]);
  return sum;
}

}  // namespace

PlaneRect shadow_reach(std::span<const LightSample> samples_tag, const Bounds& box) {
  constexpr float kNothing = std::numeric_limits<float>::max();
  const PlaneRect nothing{glm::vec2(kNothing), glm::vec2(-kNothing)};
  const float farthest_m = kFarthestShadow * box.diagonal_m();
  PlaneRect reach = nothing;
  for (const LightSample& sample : samples_tag) {
    const glm::vec3 to_light(sample.direction);
    if (!(to_light.z > 0) || !(box.max_m.z > 0)) continue;
    for (const float z : {std::max(box.min_m.z, 0.0f), box.max_m.z}) {
      const glm::vec2 away = -z / std::max(to_light.z, 1e-6f) * glm::vec2(to_light);
      const glm::vec2 shift = away * std::min(1.0f, farthest_m / std::max(glm::length(away), 1e-12f));
      reach = unite(reach, {glm::vec2(box.min_m) + shift, glm::vec2(box.max_m) + shift});
    }
  }
  return reach;
}

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

  glm::dvec3 of_lights(0.0);
  for (const LightSample& sample : light.samples)
    of_lights += sample.irradiance * (std::max(sample.direction.z, 0.0) / glm::pi<double>());
  const glm::dvec3 of_rest = glm::max(dot(unshadowed_, light.whole) - dot(unshadowed_, light.split_off), 0.0);
  block_ = {};
  block_.min_max_m = glm::vec4(grid_.min_m, grid_.max_m);
  for (int c = 0; c < 3; ++c) {
    // A plane that gets no light of a colour has no shadow in it: NaN asks the shader for 1.
    const double unshadowed = of_rest[c] + of_lights[c];
    block_.one_over_unshadowed[c] =
        unshadowed > 1e-9 ? static_cast<float>(1.0 / unshadowed) : std::numeric_limits<float>::quiet_NaN();
    block_.unshadowed_rest[c] = static_cast<float>(of_rest[c]);
    block_.unshadowed_lights[c] = static_cast<float>(of_lights[c]);
  }
  block_.points = glm::ivec4(grid_.columns, grid_.rows, 0, 0);
  reach_ = {grid_.min_m, grid_.max_m};
  const PlaneRect of_shadows = shadow_reach(light.samples, box);
  if (!of_shadows.empty()) draw_lights(of_shadows, lights, box);
  block_.drawn_min_max_m = as_vec4(reach_);
  uniforms_.update(block_);
}

void ReceiverPass::draw_lights(const PlaneRect& rect, const ShadowedLights& lights, const Bounds& box) {
  const float texel_m = box.diagonal_m() / kTexelsAcrossObject;
  const glm::ivec2 size = glm::clamp(glm::ivec2((rect.max_m - rect.min_m) / texel_m) + 8, kMinTexels, kMaxTexels);
  // A few texels more, over which the shadow fades where it was cut off.
  const glm::vec2 margin_m = 4.0f * (rect.max_m - rect.min_m) / glm::vec2(size - 8);
  const PlaneRect widened{rect.min_m - margin_m, rect.max_m + margin_m};
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
