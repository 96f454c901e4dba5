#include "render/gl/program.hpp"

#include <algorithm>

#include "catchlight/error.hpp"

namespace catchlight::render {
namespace {

std::string label_of(const ProgramSource& source) {
  std::string label = source.vertex + (source.fragment.empty() ? "" : " + " + source.fragment);
  for (const std::string& define : source.defines) label += (&define == &source.defines.front() ? ": " : ", ") + define;
  return label;
}

/// What the driver says, by glGetShaderiv and glGetShaderInfoLog or their like for programs.
template <typename GetParameter, typename GetLog>
std::string log_of(GLuint id, const GetParameter& get_parameter, const GetLog& get_log) {
  GLint size = 0;
  get_parameter(id, GL_INFO_LOG_LENGTH, &size);
  std::string log(static_cast<std::size_t>(std::max(size, 1)), '\0');
  GLsizei length = 0;
  get_log(id, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

GlShader compile(GLenum stage, const ShaderText& source) {
  GlShader shader(glCreateShader(stage));
  const char* text = source.text.c_str();
  glShaderSource(shader.id(), 1, &text, nullptr);
  glCompileShader(shader.id());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  throw Error("the shader " + source.files.front() + " does not compile:\n" +
              with_file_names(log_of(shader.id(), glGetShaderiv, glGetShaderInfoLog), source));
}

std::vector<ShaderText> texts_of(const ProgramSource& source, const std::string& folder) {
  std::vector<ShaderText> texts{shader_text(source.vertex, folder)};
  if (!source.fragment.empty()) texts.push_back(shader_text(source.fragment, folder, source.defines));
  return texts;
}

GlProgram link(const ProgramSource& source, const std::vector<ShaderText>& texts) {
  GlProgram program(glCreateProgram());
  std::vector<GlShader> shaders;
  for (const ShaderText& text : texts) {
    shaders.push_back(compile(shaders.empty() ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER, text));
    glAttachShader(program.id(), shaders.back().id());
  }
  std::vector<const char*> captured;
  for (const std::string& output : source.captured) captured.push_back(output.c_str());
  glTransformFeedbackVaryings(program.id(), static_cast<GLsizei>(captured.size()), captured.data(), GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program.id());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  const std::string label = label_of(source);
  if (linked != GL_TRUE) {
    throw Error("the shaders " + label + " do not fit together:\n" + log_of(program.id(), glGetProgramiv, glGetProgramInfoLog));
  }
  glObjectLabel(GL_PROGRAM, program.id(), static_cast<GLsizei>(label.size()), label.c_str());
  return program;
}

/// The uniform's location: -1, which GL takes for nothing to be set, where the compiler dropped it because nothing reads it.
GLint locate(const GlProgram& program, const ProgramSource& source, const std::vector<ShaderText>& texts,
             const std::string& uniform) {
  const GLint location = glGetUniformLocation(program.id(), uniform.c_str());
  const auto declares = [&](const ShaderText& text) { return declares_uniform(text, uniform); };
  if (location < 0 && std::ranges::none_of(texts, declares))
    throw Error("the shaders " + label_of(source) + " have no uniform '" + uniform + "', which the program sets");
  return location;
}

}  // namespace

Program::Program(ProgramSource source, const std::string& folder) : source_(std::move(source)) {
  reload(folder);
}

void Program::reload(const std::string& folder) {
  std::vector<ShaderText> texts = texts_of(source_, folder);
  if (program_ && texts == texts_) return;
  GlProgram program = link(source_, texts);
  Locations locations;
  for (const auto& [uniform, old_location] : locations_) locations[uniform] = locate(program, source_, texts, uniform);
  texts_ = std::move(texts);
  program_ = std::move(program);
  locations_ = std::move(locations);
}

GLint Program::location(std::string_view uniform) {
  const auto found = locations_.find(uniform);
  if (found != locations_.end()) return found->second;
  const std::string name(uniform);
  return locations_[name] = locate(program_, source_, texts_, name);
}

void Program::set(std::string_view uniform, int value) {
  glProgramUniform1i(id(), location(uniform), value);
}

void Program::set(std::string_view uniform, float value) {
  glProgramUniform1f(id(), location(uniform), value);
}

void Program::set(std::string_view uniform, const glm::ivec2& value) {
  glProgramUniform2iv(id(), location(uniform), 1, &value[0]);
}

void Program::set(std::string_view uniform, const glm::ivec4& value) {
  glProgramUniform4iv(id(), location(uniform), 1, &value[0]);
}

void Program::set(std::string_view uniform, const glm::vec2& value) {
  glProgramUniform2fv(id(), location(uniform), 1, &value[0]);
}

void Program::set(std::string_view uniform, const glm::vec3& value) {
  glProgramUniform3fv(id(), location(uniform), 1, &value[0]);
}

void Program::set(std::string_view uniform, const glm::mat2& value) {
  glProgramUniformMatrix2fv(id(), location(uniform), 1, GL_FALSE, &value[0][0]);
}

void Program::set(std::string_view uniform, std::span<const float> first_elements) {
  glProgramUniform1fv(id(), location(uniform), static_cast<GLsizei>(first_elements.size()), first_elements.data());
}

}  // namespace catchlight::render
