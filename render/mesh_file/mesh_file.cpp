#include "render/mesh_file/mesh_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "catchlight/util/text.hpp"
#include "render/mesh_file/mesh_import.hpp"
#include "render/mesh_file/obj_material.hpp"
#include "render/mesh_file/tangents.hpp"

namespace catchlight::render {
namespace {

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check_positions(const std::string& path, const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!is_finite(mesh.vertices[i].position_m)) throw Error(path + ": vertex " + std::to_string(i) + " has no finite position");
  }
  const auto bad =
      std::find_if(mesh.indices.begin(), mesh.indices.end(), [&](std::uint32_t i) { return i >= mesh.vertices.size(); });
  if (bad != mesh.indices.end()) {
    throw Error(path + ": a triangle names vertex " + std::to_string(*bad) + " of " + std::to_string(mesh.vertices.size()));
  }
}

glm::dvec3 doubled_area_normal(const Mesh& mesh, std::size_t triangle) {
  const auto corner = [&](int k) { return glm::dvec3(mesh.vertices[mesh.indices[3 * triangle + k]].position_m); };
  return glm::cross(corner(1) - corner(0), corner(2) - corner(0));
}

// Triangles without area have no side: they catch no light, and their normals are noise.
void drop_degenerate_triangles(const std::string& path, ImportedMesh& imported, const WarningHandler& warn) {
  Mesh& mesh = imported.mesh;
  std::vector<std::uint32_t>& groups = imported.smoothing_group;
  std::size_t kept = 0;
  const std::size_t count = mesh.triangle_material.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!(glm::length(doubled_area_normal(mesh, i)) > 0)) continue;
    std::copy_n(mesh.indices.begin() + 3 * i, 3, mesh.indices.begin() + 3 * kept);
    if (!groups.empty()) groups[kept] = groups[i];
    mesh.triangle_material[kept++] = mesh.triangle_material[i];
  }
  mesh.indices.resize(3 * kept);
  mesh.triangle_material.resize(kept);
  if (kept < count && warn)
    warn(path + ": " + counted(count - kept, "triangle without area is", "triangles without area are") + " left out");
}

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

std::vector<std::string> named_in_ply(std::istream& in) {
  constexpr std::string_view kTexture = "comment TextureFile ";
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line) && !line.starts_with("end_header");) {
    line.erase(line.find_last_not_of(" \r") + 1);
    if (line.starts_with(kTexture)) names.push_back(line.substr(kTexture.size()));
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

Mesh load_mesh(const std::string& path, const WarningHandler& warn) {
  if (!std::ifstream(path))
    throw Error(path + ": cannot be opened; expected a mesh (glTF, OBJ or PLY), or a shape such as sphere, cube or torus");
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  ImportedMesh imported;
  if (extension == ".glb" || extension == ".gltf") {
    imported = import_gltf(path, warn);
  } else if (extension == ".obj") {
    imported = import_obj(path, warn);
  } else if (extension == ".ply") {
    imported = import_ply(path, warn);
  } else {
    throw Error(path + ": expected a mesh with the ending .glb, .gltf, .obj or .ply");
  }
  check_positions(path, imported.mesh);
  drop_degenerate_triangles(path, imported, warn);
  if (imported.mesh.indices.empty()) throw Error(path + ": holds no triangles");
  make_missing_normals(imported);
  for (Vertex& vertex : imported.mesh.vertices) vertex.normal = glm::normalize(vertex.normal);
  make_missing_tangents(imported.mesh);
  return std::move(imported.mesh);
}

std::vector<std::string> files_of_mesh(const std::string& path) {
  const std::filesystem::path file(path);
  std::string extension = file.extension();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  std::vector<std::string> files{path};
  std::ifstream in(path);
  if (extension == ".gltf")
    for (const std::string& name : named_in_gltf(in)) files.push_back(file.parent_path() / name);
  if (extension == ".ply")
    for (const std::string& name : named_in_ply(in)) files.push_back(file.parent_path() / name);
  if (extension == ".obj")
    for (const std::string& name : named_in_obj(in)) add_library(file.parent_path() / name, files);
  return files;
}

}  // namespace catchlight::render
