#include "render/gl/shader.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "catchlight/error.hpp"
#include "embedded/embedded_shaders.hpp"

namespace catchlight::render {
namespace {

std::string read_shader_file(const std::string& name, const std::string& folder) {
  if (folder.empty()) {
    const auto found = embedded_shaders().find(name);
    if (found == embedded_shaders().end()) throw Error("there is no built-in shader '" + name + "'");
    return found->second;
  }
  const std::string path = folder + "/" + name;
  std::ifstream file(path);
  if (!file) throw Error(path + ": cannot be read; --shader-dir must hold all files of shaders/");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The file named on an `#include "name"` line, or empty.
std::string included_name(const std::string& line) {
  static const std::string keyword = "#include \"";
  if (!line.starts_with(keyword)) return {};
  return line.substr(keyword.size(), line.find('"', keyword.size()) - keyword.size());
}

void append_file(ShaderText& result, const std::string& name, const std::string& folder) {
  const std::size_t number = result.files.size();
  result.files.push_back(name);
  std::istringstream lines(read_shader_file(name, folder));
  std::string line;
  for (int line_number = 1; std::getline(lines, line); ++line_number) {
    const std::string included = included_name(line);
    if (included.empty()) {
      result.text += line + "\n";
      continue;
    }
    if (std::ranges::find(result.files, included) == result.files.end()) {
      result.text += "#line 1 " + std::to_string(result.files.size()) + "\n";
      append_file(result, included, folder);
    }
    result.text += "#line " + std::to_string(line_number + 1) + " " + std::to_string(number) + "\n";
  }
}

std::string file_legend(const ShaderText& text) {
  std::string legend;
  for (std::size_t i = 0; i < text.files.size(); ++i) legend += (i ? ", " : "") + std::to_string(i) + " = " + text.files[i];
  return legend;
}

/// Nothing may stand before #version; the log's line numbers stay those of the file.
void insert_defines(std::string& text, const std::string& defines) {
  if (defines.empty()) return;
  const std::size_t at = text.find('\n', text.find("#version")) + 1;
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
  text.insert(at, defines + "#line " + std::to_string(line) + " 0\n");
}

GlShader compile(GLenum stage, const std::string& name, const std::string& folder, const std::string& defines = {}) {
  ShaderText source = shader_text(name, folder);
  insert_defines(source.text, defines);
  GlShader shader(glCreateShader(stage));
  const char* text = source.text.c_str();
  glShaderSource(shader.id(), 1, &text, nullptr);
  glCompileShader(shader.id());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw Error("the shader " + (folder.empty() ? "" : folder + "/") + name + " does not compile (files: " + file_legend(source) +
                "):\n" + log);
  }
  return shader;
}

}  // namespace

ShaderText shader_text(const std::string& name, const std::string& folder) {
  ShaderText result;
  append_file(result, name, folder);
  return result;
}

GlProgram make_program(const ProgramStages& stages, const std::string& folder) {
  GlProgram program(glCreateProgram());
  const std::string label = stages.vertex + (stages.fragment.empty() ? "" : " + " + stages.fragment);
  const GlShader vertex = compile(GL_VERTEX_SHADER, stages.vertex, folder);
  glAttachShader(program.id(), vertex.id());
  GlShader fragment;
  if (!stages.fragment.empty()) {
    fragment = compile(GL_FRAGMENT_SHADER, stages.fragment, folder, stages.defines);
    glAttachShader(program.id(), fragment.id());
  }
  if (!stages.captured.empty()) {
    glTransformFeedbackVaryings(program.id(), static_cast<GLsizei>(stages.captured.size()), stages.captured.data(),
                                GL_INTERLEAVED_ATTRIBS);
  }
  glLinkProgram(program.id());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw Error("the shaders " + label + " do not fit together:\n" + log);
  }
  glObjectLabel(GL_PROGRAM, program.id(), static_cast<GLsizei>(label.size()), label.c_str());
  return program;
}

}  // namespace catchlight::render
