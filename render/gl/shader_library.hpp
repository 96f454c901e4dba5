// The owner of all GLSL programs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "render/gl/program.hpp"

namespace catchlight::render {

class ShaderLibrary {
 public:
  /// `folder` holds the files of shaders/ in place of the embedded ones; empty: those.
  explicit ShaderLibrary(std::string folder = {}) : folder_(std::move(folder)) {}
  ShaderLibrary(const ShaderLibrary&) = delete;
  ShaderLibrary& operator=(const ShaderLibrary&) = delete;

  /// The program is compiled when it is first asked for, and is good as long as the library, over all reloads. Throws Error as
  /// Program does.
  Program& program(const ProgramSource& source);

  /// Compiles anew the programs whose files have changed. One that does not compile stays as it was; returns what is wrong with
  /// those, by file and line.
  std::vector<std::string> reload();

 private:
  std::string folder_;
  std::map<ProgramSource, Program> programs_;
};

}  // namespace catchlight::render
