// glTF 2.0: the scene graph flattened into one mesh.
#include <algorithm>
#include <array>
#include <fstream>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "catchlight/error.hpp"
#include "render/mesh/gltf.hpp"
#include "render/mesh/mesh_import.hpp"

namespace catchlight::render {
namespace {

using gltf::Document;

/// Blank space before the first brace may be this long.
constexpr std::size_t kSearchedBytes = 4096;

/// Whether a file that may be glTF is a binary one; a text begins with a brace.
bool is_binary(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<char, 4> magic{};
  in.read(magic.data(), magic.size());
  if (std::string_view(magic.data(), magic.size()) == "glTF") return true;
  in.clear();
  in.seekg(0);
  std::string text(kSearchedBytes, '\0');
  in.read(text.data(), kSearchedBytes);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");  // a byte-order mark is read over
  if (first == std::string::npos || text[first] != '{')
    throw Error(path + ": is no glTF, whatever its name says; expected a file that begins with \"glTF\" or a brace");
  return false;
}

Document open(const std::string& path) {
  Document document;
  document.path = path;
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(&gltf::keep_image_bytes, nullptr);
  const bool binary = is_binary(path);
  std::string error, warning;
  bool ok = false;
  try {
    ok = binary ? loader.LoadBinaryFromFile(&document.model, &error, &warning, path)
                : loader.LoadASCIIFromFile(&document.model, &error, &warning, path);
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  if (error.find("json.exception") != std::string::npos) throw Error(path + ": its JSON is damaged or cut short");
  if (!ok) throw Error(path + ": cannot be read as glTF 2.0: " + error.substr(0, error.find_last_not_of('\n') + 1));
  const std::string& version = document.model.asset.version;
  if (!version.starts_with("2.")) throw Error(path + ": it is glTF " + version + "; expected glTF 2.0: export it anew");
  gltf::check_required_extensions(document);
  return document;
}

glm::dmat4 parent_from_node(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  glm::dmat4 matrix(1.0);
  if (node.translation.size() == 3) matrix = glm::translate(matrix, glm::make_vec3(node.translation.data()));
  if (node.rotation.size() == 4) {
    const auto& r = node.rotation;  // x y z w
    matrix *= glm::mat4_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2])));
  }
  if (node.scale.size() == 3) matrix = glm::scale(matrix, glm::make_vec3(node.scale.data()));
  return matrix;
}

// Corners of triangles from a primitive's vertex order; odd triangles of a strip run the other way round.
std::vector<std::uint32_t> triangles_of(const std::vector<std::uint32_t>& order, int mode) {
  if (mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN) {
    return {order.begin(), order.end() - static_cast<std::ptrdiff_t>(order.size() % 3)};
  }
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i + 2 < order.size(); ++i) {
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN, odd = !fan && i % 2 == 1;
    const std::uint32_t second = order[i + (odd ? 2 : 1)], third = order[i + (odd ? 1 : 2)];
    corners.insert(corners.end(), {fan ? order[0] : order[i], second, third});
  }
  return corners;
}

class Importer {
 public:
  Importer(const Document& document, UnusedFeatures& unused) : document_(document), unused_(unused) {
    for (const tinygltf::Material& material : document.model.materials) mesh_.materials.push_back(gltf::material_of(material));
    if (mesh_.materials.size() >= 65535) throw Error(document.path + ": more than 65535 materials");
  }

  Mesh run() {
    const tinygltf::Model& model = document_.model;
    if (model.scenes.empty()) {  // a library of nodes: those without a parent
      std::vector<bool> is_child(model.nodes.size());
      for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) is_child.at(child) = true;
      }
      for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        if (!is_child[i]) add_node(static_cast<int>(i), glm::dmat4(1), 0);
      }
    } else {
      const std::size_t scene = model.defaultScene >= 0 ? model.defaultScene : 0;
      for (const int node : model.scenes.at(scene).nodes) add_node(node, glm::dmat4(1), 0);
    }
    return std::move(mesh_);
  }

 private:
  void add_node(int index, const glm::dmat4& scene_from_parent, int depth) {
    const tinygltf::Node& node = document_.model.nodes.at(index);
    if (depth > 200) throw Error(document_.path + ": nodes are nested more than 200 deep or in a circle");
    const glm::dmat4 scene_from_node = scene_from_parent * parent_from_node(node);
    if (node.mesh >= 0) {
      for (const tinygltf::Primitive& primitive : document_.model.meshes.at(node.mesh).primitives)
        add_primitive(primitive, scene_from_node);
    }
    for (const int child : node.children) add_node(child, scene_from_node, depth + 1);
  }

  void add_primitive(const tinygltf::Primitive& primitive, const glm::dmat4& scene_from_node) {
    const bool has_triangles =
        primitive.mode == -1 || (primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN);
    const auto positions = primitive.attributes.find("POSITION");
    if (!has_triangles || positions == primitive.attributes.end()) {
      return unused_.add("points and lines are left out");
    }
    const std::size_t base = mesh_.vertices.size();
    add_vertices(primitive, read("POSITION", primitive, 3), scene_from_node);
    const std::size_t count = mesh_.vertices.size() - base;
    std::vector<std::uint32_t> order;
    if (primitive.indices >= 0) {
      order = gltf::read_indices(document_, primitive.indices);
    } else {
      for (std::size_t i = 0; i < count; ++i) order.push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<std::uint32_t> corners = triangles_of(order, primitive.mode);
    if (glm::determinant(glm::dmat3(scene_from_node)) < 0) {  // mirrored: the winding turns round
      for (std::size_t i = 0; i < corners.size(); i += 3) std::swap(corners[i + 1], corners[i + 2]);
    }
    for (const std::uint32_t corner : corners) {
      if (corner >= count)
        throw Error(document_.path + ": a triangle names vertex " + std::to_string(corner) + " of " + std::to_string(count));
      mesh_.indices.push_back(static_cast<std::uint32_t>(base + corner));
    }
    mesh_.triangle_material.insert(mesh_.triangle_material.end(), corners.size() / 3, material_index(primitive.material));
  }

  // Primitives that name no material share glTF's default one, added when first needed.
  std::uint16_t material_index(int named) {
    const std::size_t count = document_.model.materials.size();
    if (named >= 0 && static_cast<std::size_t>(named) < count) return static_cast<std::uint16_t>(named);
    if (mesh_.materials.size() == count) mesh_.materials.push_back(gltf::material_of(tinygltf::Material()));
    return static_cast<std::uint16_t>(count);
  }

  std::vector<float> read(const std::string& attribute, const tinygltf::Primitive& primitive, int components) const {
    const auto found = primitive.attributes.find(attribute);
    return found == primitive.attributes.end() ? std::vector<float>() : gltf::read_floats(document_, found->second, components);
  }

  void add_vertices(const tinygltf::Primitive& primitive, const std::vector<float>& positions,
                    const glm::dmat4& scene_from_node) {
    const std::size_t base = mesh_.vertices.size(), count = positions.size() / 3;
    const std::vector<float> normals = read("NORMAL", primitive, 3), colors = read("COLOR_0", primitive, 3);
    const glm::dmat3 linear(scene_from_node), normal_matrix = glm::inverseTranspose(linear);
    for (std::size_t i = 0; i < count; ++i) {
      Vertex vertex{glm::vec3(scene_from_node * glm::dvec4(glm::make_vec3(&positions[3 * i]), 1)), glm::vec3(0)};
      if (normals.size() == positions.size()) {
        const glm::dvec3 normal = normal_matrix * glm::dvec3(glm::make_vec3(&normals[3 * i]));
        const double length = glm::length(normal);
        if (length > 0) vertex.normal = glm::vec3(normal / length);
      }
      if (colors.size() == positions.size()) vertex.color = glm::clamp(glm::make_vec3(&colors[3 * i]), 0.0f, 1.0f);
      mesh_.vertices.push_back(vertex);
    }
    color_by_texture(primitive, base);
  }

  void color_by_texture(const tinygltf::Primitive& primitive, std::size_t base) {
    if (primitive.material < 0 || static_cast<std::size_t>(primitive.material) >= document_.model.materials.size()) return;
    const auto texture = gltf::base_color_texture(document_, document_.model.materials[primitive.material]);
    if (!texture) return;
    const std::vector<float> uv = read("TEXCOORD_" + std::to_string(texture->texture_coordinates), primitive, 2);
    for (std::size_t i = 0; 2 * i + 1 < uv.size() && base + i < mesh_.vertices.size(); ++i) {
      mesh_.vertices[base + i].color *= (*texture)(glm::dvec2(uv[2 * i], uv[2 * i + 1]));
    }
  }

  const Document& document_;
  UnusedFeatures& unused_;
  Mesh mesh_;
};

}  // namespace

ImportedMesh import_gltf(const std::string& path, const WarningHandler& warn) {
  const Document document = open(path);
  try {
    ImportedMesh imported;
    UnusedFeatures unused;
    imported.mesh = Importer(document, unused).run();
    gltf::note_unused(document, unused);
    unused.report(path, warn);
    return imported;
  } catch (const std::out_of_range&) {
    throw Error(path + ": damaged glTF: a scene, node or mesh is named that does not exist");
  }
}

}  // namespace catchlight::render
