#include "render/passes/shadowed_lights.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/gl/render_target.hpp"

namespace catchlight::render {
namespace {

/// Texels of all maps together, of 16 bits: those of 96 maps of 512 x 512.
constexpr int kTexelBudget = 96 * 512 * 512;
constexpr int kMaxTexels = 2048;  ///< texels along a map's side

/// What lies deeper than a texel's middle by its own slope is still the same surface.
constexpr float kSlopeBias = 1.5f, kDepthBias = 2.0f;
/// How far above a surface its shadow is looked up, in texels.
constexpr float kLiftTexels = 1.5f;
/// How far apart triangles are looked at before all of one counts as lit, or as dark, in shares of the object's diagonal.
constexpr float kStepShare = 1.0f / 64;

int texels_for(int samples) {
  const auto side = static_cast<unsigned>(std::sqrt(kTexelBudget / std::max(samples, 1)));
  return std::min(static_cast<int>(std::bit_floor(side)), kMaxTexels);
}

GlTexture make_maps(int texels, int layers) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  glObjectLabel(GL_TEXTURE, id, -1, "shadow maps");
  glTextureStorage3D(id, 1, GL_DEPTH_COMPONENT16, texels, texels, layers);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTextureParameteri(id, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTextureParameteri(id, wrap, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(id, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  return GlTexture(id);
}

glm::dvec3 any_perpendicular(const glm::dvec3& direction) {
  const glm::dvec3 helper = std::abs(direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  return glm::normalize(glm::cross(helper, direction));
}

}  // namespace

ShadowedLights::ShadowedLights(int samples, const Bounds& object, ShaderLibrary& shaders)
    : count_(samples),
      middle_m_(object.empty() ? glm::vec3(0) : object.middle_m()),
      radius_m_(object.empty() ? 1 : object.rounded_diagonal_m() / 2),
      map_texels_(samples > 0 ? texels_for(samples) : 1),
      program_(shaders.program({.vertex = "shadow_map.vert"})),
      maps_(make_maps(map_texels_, std::max(samples, 1))),
      framebuffer_(make_framebuffer("shadow map")) {
  uniforms_.update({});
}

void ShadowedLights::update(std::span<const LightSample> samples_tag, const std::function<void()>& draw_object) {
  shader_interface::LightSampleUniforms block{};
  block.count.x = count_;
  block.sphere = glm::vec4(middle_m_, radius_m_);
  block.lift_m.x = kLiftTexels * 2 * radius_m_ / static_cast<float>(map_texels_);
  block.lift_m.y = kStepShare * 2 * radius_m_;
  for (std::size_t i = 0; i < samples_tag.size(); ++i) {
    const LightSample& sample = samples_tag[i];
    block.to_light[i] = glm::vec4(glm::vec3(sample.direction), static_cast<float>(sample.spread_rad));
    block.right[i] = glm::vec4(glm::vec3(any_perpendicular(sample.direction)), 0);
    block.irradiance[i] = glm::vec4(glm::vec3(sample.irradiance), sample.compact ? 1 : 0);
  }
  uniforms_.update(block);
  if (count_ == 0) return;

  reset_state();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, map_texels_, map_texels_);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kSlopeBias, kDepthBias);
  glUseProgram(program_.id());
  uniforms_.bind(BINDING_LIGHT_SAMPLES);
  for (int i = 0; i < count_; ++i) {
    glNamedFramebufferTextureLayer(framebuffer_.id(), GL_DEPTH_ATTACHMENT, maps_.id(), 0, i);
    const float farthest = 1;
    glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &farthest);
    program_.set("light_sample", i);
    draw_object();
  }
  glPolygonOffset(0, 0);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_TEST);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

void ShadowedLights::bind() const {
  uniforms_.bind(BINDING_LIGHT_SAMPLES);
  glBindTextureUnit(TEXTURE_SHADOW_MAPS, maps_.id());
}

}  // namespace catchlight::render
