// glTF 2.0: the scene graph flattened into one mesh.
#include <algorithm>
#include <array>
#include <fstream>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "render/mesh_file/gltf.hpp"
#include "render/mesh_file/gltf_pose.hpp"
#include "render/mesh_file/mesh_import.hpp"

namespace catchlight::render {
namespace {

using gltf::Document;

/// Blank space before the first brace may be this long.
constexpr std::size_t kSearchedBytes = 4096;

/// Tangents of 8 bits are off by a hundredth.
constexpr float kTangentTolerance = 0.05f;

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
  Importer(const Document& document, UnusedFeatures& unused, const WarningHandler& warn)
      : document_(document),
        unused_(unused),
        material_reader_(document, mesh_.textures, unused, warn),
        scene_from_nodes_(gltf::scene_from_nodes(document)) {}

  Mesh run() {
    const tinygltf::Model& model = document_.model;
    if (model.scenes.empty()) {  // a library of nodes
      for (std::size_t i = 0; i < model.nodes.size(); ++i) add_node(static_cast<int>(i));
    } else {
      const std::size_t scene = model.defaultScene >= 0 ? model.defaultScene : 0;
      for (const int node : model.scenes.at(scene).nodes) add_nodes(node);
    }
    if (mesh_.textures.empty()) mesh_.texture_coordinates.clear();
    if (mended_ > 0)
      unused_.add(counted(mended_, "texture coordinate is", "texture coordinates are") + " not finite and count as 0");
    if (bad_tangents_ > 0)
      unused_.add(counted(bad_tangents_, "tangent is", "tangents are") + " not of length 1: normal maps get new ones there");
    return std::move(mesh_);
  }

 private:
  void add_nodes(int index) {
    add_node(index);
    for (const int child : document_.model.nodes.at(index).children) add_nodes(child);
  }

  void add_node(int index) {
    const tinygltf::Node& node = document_.model.nodes.at(index);
    if (node.mesh < 0) return;
    for (const tinygltf::Primitive& primitive : document_.model.meshes.at(node.mesh).primitives) {
      const std::vector<glm::dmat4> skinned = gltf::scene_from_skinned(document_, node, primitive, scene_from_nodes_);
      if (!skinned.empty()) {
        add_primitive(node, primitive, skinned);
      } else {
        for (const glm::dmat4& place : gltf::scene_from_instances(document_, node, scene_from_nodes_[index]))
          add_primitive(node, primitive, {place});
      }
    }
  }

  /// `places` take each vertex to the scene, or its only one takes all.
  void add_primitive(const tinygltf::Node& node, const tinygltf::Primitive& primitive, const std::vector<glm::dmat4>& places) {
    const bool has_triangles =
        primitive.mode == -1 || (primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN);
    const auto positions = primitive.attributes.find("POSITION");
    if (!has_triangles || positions == primitive.attributes.end()) {
      return unused_.add("points and lines are left out");
    }
    const std::size_t base = mesh_.vertices.size();
    const UsedMaterial& material = material_of(primitive);
    add_vertices(node, primitive, places);
    add_texture_coordinates(primitive, material, base);
    note_clear_vertices(primitive, mesh_.materials[material.index]);
    if (material.has_normal_map) add_tangents(primitive, base, places);
    const std::size_t count = mesh_.vertices.size() - base;
    std::vector<std::uint32_t> order;
    if (primitive.indices >= 0) {
      order = gltf::read_indices(document_, primitive.indices);
    } else {
      for (std::size_t i = 0; i < count; ++i) order.push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<std::uint32_t> corners = triangles_of(order, primitive.mode);
    for (std::size_t i = 0; i < corners.size(); i += 3)  // mirrored: the winding turns round
      if (is_mirrored(place_of(places, corners[i]))) std::swap(corners[i + 1], corners[i + 2]);
    for (const std::uint32_t corner : corners) {
      if (corner >= count)
        throw Error(document_.path + ": a triangle names vertex " + std::to_string(corner) + " of " + std::to_string(count));
      mesh_.indices.push_back(static_cast<std::uint32_t>(base + corner));
    }
    mesh_.triangle_material.insert(mesh_.triangle_material.end(), corners.size() / 3, material.index);
  }

  static const glm::dmat4& place_of(const std::vector<glm::dmat4>& places, std::size_t vertex) {
    return places[std::min(vertex, places.size() - 1)];
  }

  static bool is_mirrored(const glm::dmat4& place) { return glm::determinant(glm::dmat3(place)) < 0; }

  struct UsedMaterial {
    std::uint16_t index;
    std::vector<int> sets;  ///< as in TexturedMaterial
    bool has_normal_map;
  };

  // One for each material and the texture coordinates that primitives have for it. Those that name none share glTF's default.
  const UsedMaterial& material_of(const tinygltf::Primitive& primitive) {
    const std::size_t count = document_.model.materials.size();
    const bool is_named = primitive.material >= 0 && static_cast<std::size_t>(primitive.material) < count;
    std::string key = is_named ? std::to_string(primitive.material) : "";
    for (const auto& [attribute, accessor] : primitive.attributes)
      if (is_named && attribute.starts_with("TEXCOORD_")) key += ' ' + attribute;
    const auto found = used_materials_.find(key);
    if (found != used_materials_.end()) return found->second;
    const gltf::TexturedMaterial made =
        material_reader_.read(is_named ? document_.model.materials[primitive.material] : tinygltf::Material(), primitive);
    if (mesh_.materials.size() >= 65535) throw Error(document_.path + ": more than 65535 materials");
    mesh_.materials.push_back(made.material);
    const UsedMaterial used{static_cast<std::uint16_t>(mesh_.materials.size() - 1), made.sets,
                            made.material.normal_texture.is_used()};
    return used_materials_.emplace(key, used).first->second;
  }

  std::vector<float> read(const std::string& attribute, const tinygltf::Primitive& primitive, int components) const {
    const auto found = primitive.attributes.find(attribute);
    return found == primitive.attributes.end() ? std::vector<float>() : gltf::read_floats(document_, found->second, components);
  }

  std::vector<float> morphed(const std::string& attribute, const tinygltf::Node& node,
                             const tinygltf::Primitive& primitive) const {
    std::vector<float> values = read(attribute, primitive, 3);
    gltf::add_morph_targets(document_, node, primitive, attribute, 3, values);
    return values;
  }

  void add_vertices(const tinygltf::Node& node, const tinygltf::Primitive& primitive, const std::vector<glm::dmat4>& places) {
    const std::vector<float> positions = morphed("POSITION", node, primitive), normals = morphed("NORMAL", node, primitive),
                             colors = read("COLOR_0", primitive, 3);
    for (std::size_t i = 0; i < positions.size() / 3; ++i) {
      const glm::dmat4& place = place_of(places, i);
      Vertex vertex{glm::vec3(place * glm::dvec4(glm::make_vec3(&positions[3 * i]), 1)), glm::vec3(0)};
      if (normals.size() == positions.size()) {
        const glm::dvec3 normal = glm::inverseTranspose(glm::dmat3(place)) * glm::dvec3(glm::make_vec3(&normals[3 * i]));
        const double length = glm::length(normal);
        if (length > 0) vertex.normal = glm::vec3(normal / length);
      }
      if (colors.size() == positions.size()) vertex.color = glm::clamp(glm::make_vec3(&colors[3 * i]), 0.0f, 1.0f);
      mesh_.vertices.push_back(vertex);
    }
  }

  void add_texture_coordinates(const tinygltf::Primitive& primitive, const UsedMaterial& material, std::size_t base) {
    mesh_.texture_coordinates.resize(mesh_.vertices.size());
    for (std::size_t set = 0; set < material.sets.size(); ++set) {
      const std::vector<float> uv = read("TEXCOORD_" + std::to_string(material.sets[set]), primitive, 2);
      for (std::size_t i = 0; 2 * i + 1 < uv.size() && base + i < mesh_.vertices.size(); ++i) {
        const bool is_finite = std::isfinite(uv[2 * i]) && std::isfinite(uv[2 * i + 1]);
        if (is_finite) mesh_.texture_coordinates[base + i].uv[set] = {uv[2 * i], uv[2 * i + 1]};
        mended_ += !is_finite;
      }
    }
  }

  void note_clear_vertices(const tinygltf::Primitive& primitive, const Material& material) {
    const auto found = primitive.attributes.find("COLOR_0");
    if (material.alpha_mode == AlphaMode::opaque || found == primitive.attributes.end()) return;
    if (document_.model.accessors.at(found->second).type != TINYGLTF_TYPE_VEC4) return;
    const std::vector<float> colors = gltf::read_floats(document_, found->second, 4);
    bool is_clear = false;
    for (std::size_t i = 3; i < colors.size(); i += 4) is_clear |= colors[i] < 1;
    if (is_clear) unused_.add("the opacity of vertices is not used, only their colour", material.name);
  }

  // Those that are no directions stay zero, to be made anew.
  void add_tangents(const tinygltf::Primitive& primitive, std::size_t base, const std::vector<glm::dmat4>& places) {
    const std::vector<float> tangents = read("TANGENT", primitive, 4);
    for (std::size_t i = 0; 4 * i + 3 < tangents.size() && base + i < mesh_.vertices.size(); ++i) {
      const glm::vec4 tangent = glm::make_vec4(&tangents[4 * i]);
      const glm::dvec3 turned = glm::dmat3(place_of(places, i)) * glm::dvec3(tangent);
      const bool is_usable = std::abs(glm::length(glm::vec3(tangent)) - 1) < kTangentTolerance &&
                             std::abs(std::abs(tangent.w) - 1) < kTangentTolerance && glm::length(turned) > 0;
      const float sign = (tangent.w < 0) != is_mirrored(place_of(places, i)) ? -1.0f : 1.0f;
      if (is_usable) mesh_.texture_coordinates[base + i].tangent = glm::vec4(glm::normalize(turned), sign);
      bad_tangents_ += !is_usable;
    }
  }

  const Document& document_;
  UnusedFeatures& unused_;
  Mesh mesh_;
  gltf::MaterialReader material_reader_;
  std::vector<glm::dmat4> scene_from_nodes_;
  std::map<std::string, UsedMaterial> used_materials_;
  std::size_t mended_ = 0, bad_tangents_ = 0;
};

}  // namespace

ImportedMesh import_gltf(const std::string& path, const WarningHandler& warn) {
  const Document document = open(path);
  try {
    ImportedMesh imported;
    UnusedFeatures unused;
    imported.mesh = Importer(document, unused, warn).run();
    gltf::note_unused(document, unused);
    unused.report(path, warn);
    return imported;
  } catch (const std::out_of_range&) {
    throw Error(path + ": damaged glTF: a scene, node or mesh is named that does not exist");
  }
}

}  // namespace catchlight::render
