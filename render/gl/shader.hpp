// GLSL programs from the files of shaders/, embedded or from a folder.
#pragma once

#include <string>
#include <vector>

#include "render/gl/gl_objects.hpp"

namespace catchlight::render {

/// A shader's text with its `#include "name"` lines replaced by those files, each file once.
struct ShaderText {
  std::string text;
  std::vector<std::string> files;  ///< files[i] is "i" of a line "i:23" in the driver's log
};

/// `folder` empty: the embedded files. Throws Error naming a file that is missing.
ShaderText shader_text(const std::string& name, const std::string& folder);

struct ProgramStages {
  std::string vertex;                 ///< file names
  std::string fragment;               ///< empty: none
  std::vector<const char*> captured;  ///< outputs written to a buffer by transform feedback, interleaved
  std::string defines = {};           ///< lines put before the fragment shader's own
};

/// Throws Error with file and log where it does not compile or link.
GlProgram make_program(const ProgramStages& stages, const std::string& folder);

}  // namespace catchlight::render
