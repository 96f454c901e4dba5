// Wavefront's OBJ: triangles and polygons, with their materials and smoothing groups.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <unordered_map>

#include "catchlight/color.hpp"
#include "catchlight/util/text.hpp"
#include "render/mesh_file/mesh_import.hpp"
#include "render/mesh_file/obj_material.hpp"
#include "render/mesh_file/text_lines.hpp"

namespace catchlight::render {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Vertex colours are meant for display, so they are decoded.
glm::vec3 linear_color(const glm::dvec3& code) {
  const glm::dvec3 inside = glm::clamp(code, 0.0, 1.0);
  return {linear_from_srgb(inside.r), linear_from_srgb(inside.g), linear_from_srgb(inside.b)};
}

/// The numbers of position, normal and texture coordinate, and the material where it has textures.
using Corner = std::array<std::uint32_t, 4>;

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::size_t hash = 0;
    for (const std::uint32_t number : corner) hash = (hash ^ number) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return hash;
  }
};

class ObjReader {
 public:
  ObjReader(const std::string& path, const WarningHandler& warn) : path_(path), warn_(warn), lines_(path) {}

  ImportedMesh run() {
    while (lines_.next()) read_line();
    if (imported_.mesh.indices.empty()) {
      throw Error(path_ + ": holds no faces" +
                  (positions_m_.empty() ? "; expected Wavefront OBJ, with lines that begin with \"v\" and \"f\""
                                        : ", only " + std::to_string(positions_m_.size()) +
                                              " points; expected triangles or polygons, in lines such as \"f 1 2 3\""));
    }
    if (imported_.mesh.textures.empty()) imported_.mesh.texture_coordinates.clear();
    unused_.report(path_, warn_);
    return std::move(imported_);
  }

 private:
  void read_line() {
    const std::string_view key = lines_.words()[0];
    if (key == "v") add_position();
    if (key == "vt") add_texture_coordinate();
    if (key == "vn") normals_.push_back(glm::dvec3(lines_.number(1), lines_.number(2), lines_.number(3)));
    if (key == "f") add_face();
    if (key == "s") smoothing_group_ = smoothing_group();
    if (key == "mtllib") read_library(std::string(lines_.rest()));
    if (key == "usemtl") material_ = material_named(std::string(lines_.rest()));
    if (key == "l" || key == "p") unused_.add("points and lines are left out");
    if (key == "curv" || key == "curv2" || key == "surf") unused_.add("free-form curves and surfaces are left out");
  }

  // x y z, x y z w, x y z r g b or x y z w r g b.
  void add_position() {
    positions_m_.emplace_back(lines_.number(1), lines_.number(2), lines_.number(3));
    const std::size_t count = lines_.words().size(), color = count - 3;
    colors_.push_back(count >= 7 ? linear_color({lines_.number(color), lines_.number(color + 1), lines_.number(color + 2)})
                                 : glm::vec3(1));
  }

  // v runs up in the file. Some write "nan" where nothing is unfolded.
  void add_texture_coordinate() {
    const auto number = [&](std::size_t i) {
      return i < lines_.words().size() ? static_cast<float>(real_from_text(lines_.words()[i]).value_or(0)) : 0.0f;
    };
    const glm::vec2 uv(number(1), 1 - number(2));
    const bool is_finite = std::isfinite(uv.x) && std::isfinite(uv.y);
    if (!is_finite) unused_.add("texture coordinates that are not finite count as 0");
    places_.push_back(is_finite ? uv : glm::vec2(0));
  }

  // Numbers above 0 count from the first one on, below 0 from the last one back.
  std::uint32_t index_from(std::string_view text, std::size_t count, const char* what) const {
    const std::optional<std::int64_t> number = integer_from_text(text);
    if (!number) lines_.refuse("\"" + std::string(text) + "\" is not the number of a " + what);
    const std::int64_t index = *number < 0 ? static_cast<std::int64_t>(count) + *number : *number - 1;
    if (index < 0 || index >= static_cast<std::int64_t>(count)) {
      lines_.refuse("a face names " + std::string(what) + ' ' + std::string(text) + " of " + std::to_string(count) +
                    " before it");
    }
    return static_cast<std::uint32_t>(index);
  }

  // `word` is v, v/vt, v//vn or v/vt/vn. What textures need tells vertices apart only where the material has some.
  std::uint32_t vertex_of(std::string_view word, bool is_textured) {
    const std::vector<std::string> parts = split(word, '/');
    const std::uint32_t position = index_from(parts[0], positions_m_.size(), "vertex");
    const bool has_normal = parts.size() > 2 && !parts[2].empty();
    const std::uint32_t normal = has_normal ? index_from(parts[2], normals_.size(), "normal") : kNone;
    const std::uint32_t place = is_textured ? index_from(parts[1], places_.size(), "texture coordinate") : kNone;
    Mesh& mesh = imported_.mesh;
    const auto [found, is_new] = vertices_.try_emplace({position, normal, place, is_textured ? material_ : kNone},
                                                       static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      mesh.texture_coordinates.emplace_back();
      if (is_textured) mesh.texture_coordinates.back().uv[0] = places_[place];
      mesh.vertices.push_back(
          {glm::vec3(positions_m_[position]), has_normal ? glm::vec3(normals_[normal]) : glm::vec3(0), colors_[position]});
    }
    return found->second;
  }

  void add_face() {
    std::vector<std::uint32_t> polygon, corners;
    std::vector<glm::dvec3> places_m;
    if (material_ == kNone) material_ = material_named("");
    const std::uint32_t material = material_of_face();
    const bool is_textured = imported_.mesh.materials[material].has_textures();
    for (std::size_t i = 1; i < lines_.words().size(); ++i) {
      polygon.push_back(vertex_of(lines_.words()[i], is_textured));
      places_m.push_back(imported_.mesh.vertices[polygon.back()].position_m);
    }
    if (polygon.size() < 3) return unused_.add("faces of fewer than three corners are left out");
    triangulate(places_m, corners);
    for (const std::uint32_t corner : corners) imported_.mesh.indices.push_back(polygon[corner]);
    imported_.mesh.triangle_material.resize(imported_.mesh.indices.size() / 3, static_cast<std::uint16_t>(material));
    imported_.smoothing_group.resize(imported_.mesh.indices.size() / 3, smoothing_group_);
  }

  // Faces without texture coordinates are of the same material without textures.
  std::uint32_t material_of_face() {
    const Material& material = imported_.mesh.materials[material_];
    const auto& words = lines_.words();
    const bool has_places = std::all_of(words.begin() + 1, words.end(), [](std::string_view word) {
      const std::size_t slash = word.find('/');
      return slash + 1 < word.size() && slash != std::string_view::npos && word[slash + 1] != '/';
    });
    if (has_places || !material.has_textures()) return material_;
    unused_.add("faces without texture coordinates are drawn without the textures", material.name);
    const auto found = untextured_.find(material_);
    if (found != untextured_.end()) return found->second;
    Material plain = material;
    for (MaterialTexture* use : plain.texture_uses()) *use = {};
    return untextured_[material_] = add_material(std::move(plain));
  }

  std::uint32_t smoothing_group() const {
    const std::string_view word = lines_.words().size() > 1 ? lines_.words()[1] : "off";
    if (word == "on") return 1;
    return static_cast<std::uint32_t>(integer_from_text(word).value_or(0));
  }

  void read_library(const std::string& name) {
    const std::string library = std::filesystem::path(path_).parent_path() / name;
    if (!std::filesystem::is_regular_file(library)) {
      if (warn_) warn_(path_ + ": its material library \"" + name + "\" is not there: the object is grey");
      return;
    }
    for (Material& material : read_obj_materials(library, textures_, unused_, warn_)) add_material(std::move(material));
  }

  std::uint32_t add_material(Material material) {
    std::vector<Material>& materials = imported_.mesh.materials;
    if (materials.size() >= 65536) throw Error(path_ + ": more than 65536 materials");
    materials_.try_emplace(material.name, static_cast<std::uint32_t>(materials.size()));
    materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(materials.size() - 1);
  }

  std::uint32_t material_named(const std::string& name) {
    const auto found = materials_.find(name);
    if (found != materials_.end()) return found->second;
    Material material = obj_default_material();
    material.name = name;
    return add_material(std::move(material));
  }

  const std::string& path_;
  const WarningHandler& warn_;
  TextLines lines_;
  UnusedFeatures unused_;
  ImportedMesh imported_;
  std::vector<glm::dvec3> positions_m_, normals_;
  TextureList textures_{imported_.mesh.textures};
  std::vector<glm::vec3> colors_;
  std::vector<glm::vec2> places_;  ///< in textures, v down
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
  std::unordered_map<std::uint32_t, std::uint32_t> untextured_;  ///< materials without their textures
  std::unordered_map<std::string, std::uint32_t> materials_;
  std::uint32_t material_ = kNone, smoothing_group_ = 0;
};

}  // namespace

ImportedMesh import_obj(const std::string& path, const WarningHandler& warn) {
  return ObjReader(path, warn).run();
}

}  // namespace catchlight::render
