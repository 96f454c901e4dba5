// A fragment program for each number of taps. With the number known when it is compiled its loop unrolls and the weights have
// fixed places; a loop of unknown length over a uniform array costs a software rasteriser several times as much, and all of the
// array.
#pragma once

#include <map>
#include <string>

#include "render/gl/shader.hpp"

namespace catchlight::render {

class TapPrograms {
 public:
  /// `defines`: further lines for the fragment shader.
  TapPrograms(std::string fragment, std::string shader_folder, std::string defines = {})
      : fragment_(std::move(fragment)), shader_folder_(std::move(shader_folder)), defines_(std::move(defines)) {}

  /// Compiled with TAPS defined as `count`, when it is first asked for.
  GLuint with(int count) const {
    const auto found = programs_.find(count);
    if (found != programs_.end()) return found->second.id();
    const std::string defines = defines_ + "#define TAPS " + std::to_string(count) + "\n";
    const ProgramStages stages{.vertex = "fullscreen.vert", .fragment = fragment_, .captured = {}, .defines = defines};
    return programs_.emplace(count, make_program(stages, shader_folder_)).first->second.id();
  }

 private:
  std::string fragment_, shader_folder_, defines_;
  mutable std::map<int, GlProgram> programs_;
};

}  // namespace catchlight::render
