#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "render/mesh/mesh_file.hpp"
#include "render/mesh/obj_material.hpp"

namespace catchlight::render {
namespace {

// The files that the glTF document names in its buffers and images; data that stands in the document itself is none.
std::vector<std::string> named_in_gltf(std::istream& in) {
  std::vector<std::string> names;
  const nlohmann::json document = nlohmann::json::parse(in, nullptr, false);
  for (const char* list : {"buffers", "images"}) {
    if (!document.is_object() || !document.contains(list) || !document[list].is_array()) continue;
    for (const auto& entry : document[list])
      if (entry.is_object() && entry.contains("uri") && entry["uri"].is_string()) names.push_back(entry["uri"]);
  }
  std::erase_if(names, [](const std::string& name) { return name.starts_with("data:"); });
  return names;
}

std::vector<std::string> named_in_obj(std::istream& in) {
  constexpr std::string_view kLibrary = "mtllib ";
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(kLibrary)) continue;
    line.erase(line.find_last_not_of(" \r") + 1);
    names.push_back(line.substr(std::min(kLibrary.size(), line.size())));
  }
  return names;
}

void add_library(const std::string& path, std::vector<std::string>& files) {
  files.push_back(path);
  try {
    for (const std::string& picture : pictures_of_obj_materials(path)) files.push_back(picture);
  } catch (const Error&) {  // damaged, or not there: it names none
  }
}

}  // namespace

std::vector<std::string> files_of_mesh(const std::string& path) {
  const std::filesystem::path file(path);
  std::string extension = file.extension();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  std::vector<std::string> files{path};
  std::ifstream in(path);
  if (extension == ".gltf")
    for (const std::string& name : named_in_gltf(in)) files.push_back(file.parent_path() / name);
  if (extension == ".obj")
    for (const std::string& name : named_in_obj(in)) add_library(file.parent_path() / name, files);
  return files;
}

}  // namespace catchlight::render
