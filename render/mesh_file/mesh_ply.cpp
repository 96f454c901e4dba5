// PLY, as scanners and MeshLab write it: vertices with normals and colours; faces or strips of triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "catchlight/color.hpp"
#include "catchlight/util/text.hpp"
#include "render/mesh_file/mesh_import.hpp"
#include "render/mesh_file/ply_values.hpp"
#include "render/mesh_file/texture_file.hpp"
#include "render/mesh_file/unused_features.hpp"

namespace catchlight::render {
namespace {

/// What bends less counts as smooth: a scan's surface or a coarse ball, not the edge of a box.
constexpr double kSmoothBelowDeg = 45;

/// MeshLab's comment before the name of a picture.
constexpr std::string_view kTextureFile = "TextureFile ";

/// What is read of a vertex, in this order, under the names that programs give it.
constexpr std::array<std::array<const char*, 3>, 11> kVertexNames{{{"x", "", ""},
                                                                   {"y", "", ""},
                                                                   {"z", "", ""},
                                                                   {"nx", "", ""},
                                                                   {"ny", "", ""},
                                                                   {"nz", "", ""},
                                                                   {"red", "diffuse_red", ""},
                                                                   {"green", "diffuse_green", ""},
                                                                   {"blue", "diffuse_blue", ""},
                                                                   {"texture_u", "s", "u"},
                                                                   {"texture_v", "t", "v"}}};
constexpr std::size_t kRed = 6, kU = 9;

/// Colours are codes for display: of integers the greatest is 1.
double full_scale(PlyType type) {
  return type == PlyType::uint8 ? 255 : type == PlyType::uint16 ? 65535 : 1;
}

class PlyReader {
 public:
  explicit PlyReader(const std::string& path) : path_(path), values_(path) {}

  ImportedMesh run(const WarningHandler& warn) {
    for (const PlyElement& element : values_.elements())
      if (element.name == "vertex") vertex_count_ = element.count;
    for (const PlyElement& element : values_.elements()) read_element(element);
    add_triangles();
    for (const std::string& comment : values_.comments())
      if (comment.starts_with(kTextureFile)) add_texture(comment, warn);
    if (imported_.mesh.textures.empty()) imported_.mesh.texture_coordinates.clear();
    if (imported_.mesh.indices.empty()) {
      values_.refuse("holds no faces" + (vertex_count_ > 0 ? ", only " + std::to_string(vertex_count_) + " points" : "") +
                     "; expected a mesh of triangles or polygons");
    }
    unused_.report(path_, warn);
    imported_.smooth_below_deg = kSmoothBelowDeg;
    return std::move(imported_);
  }

 private:
  void read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex", is_strips = element.name == "tristrips";
    if (!is_vertex && !is_strips && element.name != "face" && element.count > 0)
      unused_.add("its element \"" + element.name + "\" is not used");
    if (is_vertex) begin_vertices(element);
    for (std::size_t row = 0; row < element.count; ++row) {
      if (is_vertex) {
        add_vertex(element);
      } else {
        read_row(element, is_strips);
      }
    }
  }

  // The first one only: which faces have which of several is written in many ways.
  void add_texture(const std::string& comment, const WarningHandler& warn) {
    Mesh& mesh = imported_.mesh;
    if (!has_member_[kU] || !has_member_[kU + 1] || !mesh.textures.empty())
      return unused_.add("its texture (" + comment + ") is not used");
    const std::string name = comment.substr(kTextureFile.size());
    try {
      mesh.textures.push_back(
          read_texture(std::filesystem::path(path_).parent_path() / name, {.is_srgb = true, .wrap = {}}, warn));
    } catch (const Error& error) {
      if (warn) warn(path_ + ": its texture is left out: " + error.what());
      return;
    }
    mesh.materials[0].base_color_texture.texture = 0;
    if (!has_member_[kRed]) mesh.materials[0].base_color = glm::vec3(1);
  }

  void begin_vertices(const PlyElement& element) {
    member_.assign(element.properties.size(), kVertexNames.size());
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      for (std::size_t m = 0; m < kVertexNames.size(); ++m)
        if (!property.count_type && std::ranges::find(kVertexNames[m], property.name) != kVertexNames[m].end()) member_[i] = m;
      has_member_[member_[i]] = true;
    }
    if (!has_member_[0] || !has_member_[1] || !has_member_[2]) values_.refuse("its vertices have no x, y and z");
    const bool is_colored = has_member_[kRed] && has_member_[kRed + 1] && has_member_[kRed + 2];
    imported_.mesh.materials.emplace_back().base_color = glm::vec3(is_colored ? 1.0f : 0.6f);
    imported_.mesh.vertices.reserve(element.count);
  }

  void add_vertex(const PlyElement& element) {
    std::array<double, kVertexNames.size() + 1> value{0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.count_type) {
        skip_list(property);
      } else {
        const bool is_color = member_[i] >= kRed && member_[i] < kU;
        value[member_[i]] = values_.next(property.type) / (is_color ? full_scale(property.type) : 1);
      }
    }
    const auto vector = [&](std::size_t first) { return glm::dvec3(value[first], value[first + 1], value[first + 2]); };
    const glm::dvec3 code = glm::clamp(vector(kRed), 0.0, 1.0);
    imported_.mesh.vertices.push_back({glm::vec3(vector(0)), glm::vec3(vector(3)),
                                       glm::vec3(linear_from_srgb(code.r), linear_from_srgb(code.g), linear_from_srgb(code.b))});
    const glm::vec2 uv(value[kU], 1 - value[kU + 1]);  // v runs up in the file
    const bool is_finite = std::isfinite(uv.x) && std::isfinite(uv.y);
    if (!is_finite) unused_.add("texture coordinates that are not finite count as 0");
    imported_.mesh.texture_coordinates.push_back({{is_finite ? uv : glm::vec2(0), glm::vec2(0)}, glm::vec4(0)});
  }

  void skip_list(const PlyProperty& property) {
    for (std::size_t count = values_.next_count(*property.count_type, property.type); count > 0; --count)
      values_.next(property.type);
  }

  void read_row(const PlyElement& element, bool is_strips) {
    for (const PlyProperty& property : element.properties) {
      if (property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index")) {
        list_.clear();
        for (std::size_t count = values_.next_count(*property.count_type, property.type); count > 0; --count)
          list_.push_back(values_.next(property.type));
        if (is_strips) add_strips();
        if (element.name == "face") add_face();
      } else if (property.count_type) {
        skip_list(property);
      } else {
        values_.next(property.type);
        if (element.name == "face" && property.name == "red")
          unused_.add("colours of faces are not used, only those of vertices");
      }
    }
  }

  std::uint32_t vertex_index(double value) const {
    if (!(value >= 0) || value != std::floor(value) || value >= static_cast<double>(vertex_count_)) {
      values_.refuse("face " + std::to_string(polygon_sizes_.size()) + " names vertex " + number_text(value) + " of " +
                     std::to_string(vertex_count_));
    }
    return static_cast<std::uint32_t>(value);
  }

  void add_face() {
    if (list_.size() < 3) return unused_.add("faces of fewer than three corners are left out");
    for (const double value : list_) polygon_corners_.push_back(vertex_index(value));
    polygon_sizes_.push_back(list_.size());
  }

  // -1 ends a strip; its odd triangles run the other way round.
  void add_strips() {
    std::size_t start = 0;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i] == -1) start = i + 1;
      if (i < start + 2) continue;
      const bool is_odd = (i - start) % 2 == 1;
      for (const std::size_t corner : {i - 2, is_odd ? i : i - 1, is_odd ? i - 1 : i})
        polygon_corners_.push_back(vertex_index(list_[corner]));
      polygon_sizes_.push_back(3);
    }
  }

  // Vertices may come behind the faces in the file, so that polygons are cut last.
  void add_triangles() {
    Mesh& mesh = imported_.mesh;
    std::size_t first = 0;
    for (const std::size_t size : polygon_sizes_) {
      std::vector<std::uint32_t> corners{0, 1, 2};
      if (size > 3) {
        std::vector<glm::dvec3> places_m;
        for (std::size_t i = 0; i < size; ++i) places_m.push_back(mesh.vertices[polygon_corners_[first + i]].position_m);
        corners.clear();
        triangulate(places_m, corners);
      }
      for (const std::uint32_t corner : corners) mesh.indices.push_back(polygon_corners_[first + corner]);
      first += size;
    }
    mesh.triangle_material.resize(mesh.indices.size() / 3);
  }

  const std::string& path_;
  PlyValues values_;
  UnusedFeatures unused_;
  ImportedMesh imported_;
  std::size_t vertex_count_ = 0;
  std::vector<std::size_t> member_;
  std::array<bool, kVertexNames.size() + 1> has_member_{};
  std::vector<double> list_;
  std::vector<std::uint32_t> polygon_corners_;  ///< of all polygons, one after the other
  std::vector<std::size_t> polygon_sizes_;
};

}  // namespace

ImportedMesh import_ply(const std::string& path, const WarningHandler& warn) {
  return PlyReader(path).run(warn);
}

}  // namespace catchlight::render
