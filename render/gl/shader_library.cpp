#include "render/gl/shader_library.hpp"

#include "catchlight/error.hpp"

namespace catchlight::render {

Program& ShaderLibrary::program(const ProgramSource& source) {
  return programs_.try_emplace(source, source, folder_).first->second;
}

std::vector<std::string> ShaderLibrary::reload() {
  std::vector<std::string> problems;
  for (auto& [source, program] : programs_) {
    try {
      program.reload(folder_);
    } catch (const Error& error) {
      problems.emplace_back(error.what());
    }
  }
  return problems;
}

}  // namespace catchlight::render
