#include "render/mesh_file/obj_material.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/mesh_file/obj_texture.hpp"
#include "render/mesh_file/text_lines.hpp"

namespace catchlight::render {
namespace {

/// What a library says and nobody draws, but for maps.
struct Unused {
  std::string_view key;
  double neutral;  ///< the value that changes nothing
  const char* what;
};
constexpr std::array kUnused{Unused{"d", 1, "transparency (d) is not used: it is opaque"},
                             Unused{"Tr", 0, "transparency (Tr) is not used: it is opaque"},
                             Unused{"Pc", 0, "clear coat (Pc) is not used"}, Unused{"Ps", 0, "sheen (Ps) is not used"},
                             Unused{"aniso", 0, "anisotropy (aniso) is not used"}};

bool is_map(std::string_view key) {
  constexpr std::array<std::string_view, 6> kMaps{"bump", "norm", "disp", "decal", "refl", "lenv"};
  return key.starts_with("map_") || std::find(kMaps.begin(), kMaps.end(), key) != kMaps.end();
}

bool is_bump(std::string_view key) {
  return key == "bump" || key == "map_bump" || key == "map_Bump" || key == "norm";
}

void note_map(std::string_view key, const Material& material, UnusedFeatures& unused) {
  const bool is_drawn = key == "map_Kd" || key == "map_Ke" || (is_bump(key) && material.normal_texture.is_used());
  if (is_map(key) && !is_drawn) unused.add("maps (" + std::string(key) + ") are not used", material.name);
}

glm::vec3 color(const TextLines& lines) {
  if (lines.words().size() > 1 && (lines.words()[1] == "spectral" || lines.words()[1] == "xyz"))
    lines.refuse("a colour given by \"" + std::string(lines.words()[1]) + "\" is not read; expected three numbers");
  if (lines.words().size() == 2) return glm::vec3(lines.number(1));
  return {lines.number(1), lines.number(2), lines.number(3)};
}

void note_unused(const TextLines& lines, const Material& material, UnusedFeatures& unused) {
  const std::string_view key = lines.words()[0];
  note_map(key, material, unused);
  for (const Unused& feature : kUnused)
    if (key == feature.key && lines.number(lines.words().size() - 1) != feature.neutral) unused.add(feature.what, material.name);
}

/// Blinn-Phong's exponent s = 2 / alpha^2 - 2.
float roughness_of_exponent(double exponent) {
  return static_cast<float>(std::pow(2 / (exponent + 2), 0.25));
}

/// Reads a library's materials line by line.
class LibraryReader {
 public:
  LibraryReader(const std::string& path, TextureList& textures, const WarningHandler& warn) : textures_(path, textures, warn) {}

  void read(const TextLines& lines, Material& material) {
    const std::string_view key = lines.words()[0];
    if (key == "newmtl") has_roughness_ = has_color_ = false;
    if (key == "Kd") material.base_color = glm::clamp(color(lines), 0.0f, 1.0f), has_color_ = true;
    if (key == "Ke") material.emissive = glm::max(color(lines), 0.0f);
    if (key == "Ks") material.dielectric_f0 = color(lines) == glm::vec3(0) ? 0.0f : Material{}.dielectric_f0;
    if (key == "Ns" && !has_roughness_ && lines.number(1) > 0) material.roughness = roughness_of_exponent(lines.number(1));
    if (key == "Pm") material.metallic = unit(lines.number(1));
    if (key == "Pr") material.roughness = unit(lines.number(1)), has_roughness_ = true;
    if (key == "d") material.opacity = unit(lines.number(lines.words().size() - 1));
    if (key == "Tr") material.opacity = 1 - unit(lines.number(1));
    if (key == "map_Kd") material.base_color_texture = textures_.read(lines, true);
    if (key == "map_Ke") material.emissive_texture = textures_.read(lines, true);
    if (is_bump(key)) material.normal_texture = textures_.read_normals(lines);
  }

  /// Many programs write black, or nothing, where a map says all: the map is shown.
  void finish(Material& material) const {
    const bool has_no_color = !has_color_ || material.base_color == glm::vec3(0);
    if (material.base_color_texture.is_used() && has_no_color) material.base_color = glm::vec3(1);
    if (material.emissive_texture.is_used() && material.emissive == glm::vec3(0)) material.emissive = glm::vec3(1);
    if (material.opacity < 1) material.alpha_mode = AlphaMode::blend;
  }

 private:
  static float unit(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

  ObjTextureReader textures_;
  bool has_roughness_ = false, has_color_ = false;
};

}  // namespace

Material obj_default_material() {
  Material material;
  material.base_color = glm::vec3(0.6f);
  material.dielectric_f0 = 0;
  return material;
}

std::vector<Material> read_obj_materials(const std::string& path, TextureList& textures, UnusedFeatures& unused,
                                         const WarningHandler& warn) {
  std::vector<Material> materials;
  LibraryReader reader(path, textures, warn);
  for (TextLines lines(path); lines.next();) {
    if (lines.words()[0] == "newmtl") {
      if (!materials.empty()) reader.finish(materials.back());
      materials.push_back(obj_default_material());
      materials.back().name = lines.rest();
    }
    if (materials.empty()) continue;
    reader.read(lines, materials.back());
    note_unused(lines, materials.back(), unused);
  }
  if (!materials.empty()) reader.finish(materials.back());
  return materials;
}

std::vector<std::string> pictures_of_obj_materials(const std::string& path) {
  std::vector<std::string> pictures;
  for (TextLines lines(path); lines.next();)
    if (is_map(lines.words()[0])) pictures.push_back(path_of_obj_map(path, obj_map(lines)));
  std::erase(pictures, "");
  return pictures;
}

}  // namespace catchlight::render
