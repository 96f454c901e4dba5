// A vertex shader run over points, its output kept in a buffer; nothing is drawn.
#pragma once

#include <string>

#include "render/gl/gl_objects.hpp"
#include "render/gl/shader_library.hpp"

namespace catchlight::render {

class PointCapture {
 public:
  /// `output`: the shader's vec3 to keep.
  PointCapture(const std::string& vertex_shader, const std::string& output, ShaderLibrary& shaders);

  /// Captures 3 floats each for points 0 to `points` - 1, from byte `offset` of `target` on.
  void run(GLuint target, GLintptr offset, int points) const;

 private:
  Program& program_;
  GlVertexArray no_attributes_;
  GlFramebuffer
      no_pixels_;  ///< GL wants a complete framebuffer even where nothing is drawn, and a context without a window has none
};

}  // namespace catchlight::render
