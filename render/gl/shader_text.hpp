// Shaders' texts: the files of shaders/, embedded or from a folder, put together.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace catchlight::render {

/// A shader's text with its `#include "name"` lines replaced by those files, each file once.
struct ShaderText {
  std::string text;
  std::vector<std::string> files;  ///< files[i] is "i" of a line "i:23" in the driver's log

  bool operator==(const ShaderText&) const = default;
};

/// `folder` empty: the embedded files. `defines` ("NAME" or "NAME value") hold for all of the text. Throws Error naming a file
/// that is missing.
ShaderText shader_text(const std::string& name, const std::string& folder, const std::vector<std::string>& defines = {});

/// Throws Error where `folder` does not hold all files of shaders/.
void check_shader_folder(const std::string& folder);

/// A driver's log with the files' names in place of their numbers: "distortion.glsl:23" for "2:23".
std::string with_file_names(std::string_view log, const ShaderText& text);

/// Whether the text has a uniform of that name outside of blocks, be it used or not.
bool declares_uniform(const ShaderText& text, std::string_view name);

}  // namespace catchlight::render
