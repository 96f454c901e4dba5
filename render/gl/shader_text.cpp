#include "render/gl/shader_text.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "catchlight/error.hpp"
#include "embedded/embedded_shaders.hpp"

namespace catchlight::render {
namespace {

std::string path_of(const std::string& name, const std::string& folder) {
  return folder.empty() ? name : folder + "/" + name;
}

std::string read_shader_file(const std::string& name, const std::string& folder) {
  if (folder.empty()) {
    const auto found = embedded_shaders().find(name);
    if (found == embedded_shaders().end()) throw Error("there is no built-in shader '" + name + "'");
    return found->second;
  }
  const std::string path = path_of(name, folder);
  std::ifstream file(path);
  if (!file) throw Error(path + ": cannot be read; --shader-dir must hold all files of shaders/");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The file named on an `#include "name"` line, or empty. Names with folders stand in parts that only C++ compiles.
std::string included_name(const std::string& line) {
  static const std::string keyword = "#include \"";
  if (!line.starts_with(keyword)) return {};
  const std::string name = line.substr(keyword.size(), line.find('"', keyword.size()) - keyword.size());
  return name.find('/') == std::string::npos ? name : std::string();
}

void append_file(ShaderText& result, const std::string& name, const std::string& folder) {
  const std::size_t number = result.files.size();
  result.files.push_back(path_of(name, folder));
  std::istringstream lines(read_shader_file(name, folder));
  std::string line;
  for (int line_number = 1; std::getline(lines, line); ++line_number) {
    const std::string included = included_name(line);
    if (included.empty()) {
      result.text += line + "\n";
      continue;
    }
    if (std::ranges::find(result.files, path_of(included, folder)) == result.files.end()) {
      result.text += "#line 1 " + std::to_string(result.files.size()) + "\n";
      append_file(result, included, folder);
    }
    result.text += "#line " + std::to_string(line_number + 1) + " " + std::to_string(number) + "\n";
  }
}

/// Inserts the defines: nothing may stand before #version, and the log's line numbers stay those of the file.
void insert_defines(std::string& text, const std::vector<std::string>& defines) {
  if (defines.empty()) return;
  const std::size_t at = text.find('\n', text.find("#version")) + 1;
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
  std::string lines;
  for (const std::string& define : defines) lines += "#define " + define + "\n";
  text.insert(at, lines + "#line " + std::to_string(line) + " 0\n");
}

}  // namespace

ShaderText shader_text(const std::string& name, const std::string& folder, const std::vector<std::string>& defines) {
  ShaderText result;
  append_file(result, name, folder);
  insert_defines(result.text, defines);
  return result;
}

void check_shader_folder(const std::string& folder) {
  if (!std::filesystem::is_directory(folder))
    throw Error("--shader-dir: there is no folder " + folder + "; expected a copy of shaders/, to be edited");
  for (const auto& [name, text] : embedded_shaders()) read_shader_file(name, folder);
}

std::string with_file_names(std::string_view log, const ShaderText& text) {
  // As Mesa says it, "2:23(9): error", as others do, "ERROR: 2:23:", and as NVIDIA does, "2(23) : error".
  static const std::regex place(R"(^(ERROR: |WARNING: )?(\d+)[:(](\d+)\)?(.*)$)");
  std::string result, line;
  for (std::istringstream lines{std::string(log)}; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_match(line, found, place) && std::stoul(found[2]) < text.files.size())
      line = text.files[std::stoul(found[2])] + ":" + found[3].str() + found[4].str();
    result += line + "\n";
  }
  return result;
}

bool declares_uniform(const ShaderText& text, std::string_view name) {
  static const std::regex declaration(R"(\buniform\s+\w+\s+(\w+)\s*[;\[])");
  std::istringstream lines(text.text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (line.find("uniform") != std::string::npos && std::regex_search(line, found, declaration) && found[1].str() == name)
      return true;
  }
  return false;
}

}  // namespace catchlight::render
