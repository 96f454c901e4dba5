// The lights split off the probe on the GPU: their samples, and a shadow map for each.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "render/gl/gl_objects.hpp"
#include "render/gl/shader_library.hpp"
#include "render/mesh/bounds.hpp"
#include "render/probe/light_samples.hpp"
#include "shaders/interface.h"

namespace catchlight::render {

class ShadowedLights {
 public:
  /// Makes room for `samples` samples, at most MAX_LIGHT_SAMPLES; none is possible too. All that casts shadows is in the box (tag
  /// frame).
  ShadowedLights(int samples, const Bounds& object, ShaderLibrary& shaders);

  /// Takes over the samples (tag frame; as many as said) and draws their maps; `draw_object` draws all triangles with their
  /// positions as ATTRIBUTE_POSITION. Needed again only when the light turns.
  void update(std::span<const LightSample> samples_tag, const std::function<void()>& draw_object);

  int count() const { return count_; }
  /// Binds what shaders need that include lights.glsl.
  void bind() const;

 private:
  int count_;
  glm::vec3 middle_m_;  ///< middle of the sphere around the box
  float radius_m_;
  int map_texels_;
  Program& program_;
  GlTexture maps_;
  GlFramebuffer framebuffer_;
  UniformBuffer<shader_interface::LightSampleUniforms> uniforms_{"light samples"};
};

}  // namespace catchlight::render
