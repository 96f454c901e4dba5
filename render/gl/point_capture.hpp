// A vertex shader run over points, its output kept in a buffer; nothing is drawn.
#pragma once

#include <string>
#include <vector>

#include "render/gl/gl_objects.hpp"
#include "render/gl/shader_library.hpp"

namespace catchlight::render {

class PointCapture {
 public:
  /// `outputs`: what to keep of the shader's, one after the other, `point_bytes` in all.
  PointCapture(const std::string& vertex_shader, std::vector<std::string> outputs, std::size_t point_bytes,
               ShaderLibrary& shaders);

  /// Captures points 0 to `points` - 1, from byte `offset` of `target` on.
  void run(GLuint target, GLintptr offset, int points) const;

 private:
  Program& program_;
  GLsizeiptr point_bytes_;
  GlVertexArray no_attributes_;
  GlFramebuffer
      no_pixels_;  ///< GL wants a complete framebuffer even where nothing is drawn, and a context without a window has none
};

}  // namespace catchlight::render
