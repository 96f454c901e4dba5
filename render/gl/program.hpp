// A linked GLSL program, and what it is made of.
#pragma once

#include <compare>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl/gl_objects.hpp"
#include "render/gl/shader_text.hpp"

namespace catchlight::render {

/// The files that a program is linked from, by their names in shaders/.
struct ProgramSource {
  std::string vertex;
  std::string fragment = {};               ///< empty: none
  std::vector<std::string> defines = {};   ///< "NAME" or "NAME value", for the fragment shader
  std::vector<std::string> captured = {};  ///< the vertex shader's outputs that transform feedback writes to a buffer

  auto operator<=>(const ProgramSource&) const = default;
};

class Program {
 public:
  /// Throws Error with file, line and what the driver says where it does not compile or link.
  Program(ProgramSource source, const std::string& folder);

  /// Compiles the program anew if its files have changed. Where that fails it throws Error and stays the program that it was.
  void reload(const std::string& folder);

  GLuint id() const { return program_.id(); }

  /// Sets a uniform by its name. A uniform that the shaders declare and never read may be set too, to no effect; a name that they
  /// do not declare is an Error. check_gl() finds a value of another type than the uniform's.
  void set(std::string_view uniform, int value);
  void set(std::string_view uniform, float value);
  void set(std::string_view uniform, const glm::ivec2& value);
  void set(std::string_view uniform, const glm::ivec4& value);
  void set(std::string_view uniform, const glm::vec2& value);
  void set(std::string_view uniform, const glm::vec3& value);
  void set(std::string_view uniform, const glm::mat2& value);
  void set(std::string_view uniform, std::span<const float> first_elements);

 private:
  using Locations = std::map<std::string, GLint, std::less<>>;

  GLint location(std::string_view uniform);

  ProgramSource source_;
  std::vector<ShaderText> texts_;
  GlProgram program_;
  Locations locations_;  ///< all uniforms that were ever set
};

}  // namespace catchlight::render
