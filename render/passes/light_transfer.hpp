// Precomputed radiance transfer on the GPU: light coefficients in, light per point out.
#pragma once

#include <span>
#include <string>

#include "render/gl/gl_objects.hpp"
#include "render/gl/point_capture.hpp"
#include "render/math/sh.hpp"
#include "shaders/interface.h"

namespace catchlight::render {

/// The program and light that all LitPoints share.
class LightTransfer {
 public:
  explicit LightTransfer(ShaderLibrary& shaders) : capture_("transfer.vert", {"transferred"}, sizeof(glm::vec3), shaders) {}

  /// Sets the light's coefficients, at most MAX_LIGHT_COEFFICIENTS. `split_off` is the part of them whose direct way is left to
  /// shadow maps: as many, or none.
  void set_light(const ShRgb& light_linear, const ShRgb& split_off = {});
  int coefficients() const { return coefficients_; }

  /// Captures `points` vertices' worth of transferred light (3 floats each) from byte `offset` of `target` on.
  void capture(GLuint target, GLintptr offset, int points) const;

 private:
  PointCapture capture_;
  UniformBuffer<shader_interface::LightUniforms> uniforms_{"light"};
  int coefficients_ = 0;
};

/// Points with their transfer coefficients; any number of bands and points (worked through in chunks that GL can bind).
class LitPoints {
 public:
  /// `transfer` holds a multiple of `coefficients` values, point by point; `direct`, the part of it that met no other surface, as
  /// many, or none where no light is ever split off.
  LitPoints(const std::string& label, std::span<const glm::vec3> transfer, std::span<const glm::vec3> direct, int coefficients);

  /// Finds the sum of light times transfer per point less what lights that are split off send directly, >= 0.
  void evaluate(const LightTransfer& light);

  int count() const { return count_; }
  /// The buffer of what evaluate() found: count() times 3 floats.
  GLuint radiance() const { return radiance_.id(); }

 private:
  int count_;
  bool has_direct_;
  GlBuffer transfer_, direct_, radiance_;
};

}  // namespace catchlight::render
