// Precomputed radiance transfer on the GPU: light coefficients in, light per point out.
#pragma once

#include <span>
#include <string>

#include "render/gl_objects.hpp"
#include "render/sh.hpp"
#include "shaders/interface.h"

namespace catchlight::render {

/// The program and light that all LitPoints share.
class LightTransfer {
 public:
  explicit LightTransfer(const std::string& shader_folder);

  /// At most MAX_LIGHT_COEFFICIENTS.
  void set_light(const ShRgb& light_linear);
  int coefficients() const { return coefficients_; }

  /// Captures `points` vertices' worth of transferred light (3 floats each) from byte `offset` of `target` on.
  void capture(GLuint target, GLintptr offset, int points) const;

 private:
  GlProgram program_;
  GlVertexArray no_attributes_;
  GlFramebuffer
      no_pixels_;  ///< GL wants a complete framebuffer even where nothing is drawn, and a context without a window has none
  UniformBuffer<shader_interface::LightUniforms> uniforms_{"light"};
  int coefficients_ = 0;
};

/// Points with their transfer coefficients; any number of bands and points (worked through in chunks that GL can bind).
class LitPoints {
 public:
  /// `transfer` holds a multiple of `coefficients` values, point by point.
  LitPoints(const std::string& label, std::span<const glm::vec3> transfer, int coefficients);

  /// Sum of light times transfer per point, >= 0.
  void evaluate(const LightTransfer& light);

  int count() const { return count_; }
  /// count() times 3 floats.
  GLuint radiance() const { return radiance_.id(); }

 private:
  int count_;
  GlBuffer transfer_, radiance_;
};

}  // namespace catchlight::render
