#include "render/mesh/obj_material.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/mesh/text_lines.hpp"

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

glm::vec3 color(const TextLines& lines) {
  if (lines.words().size() > 1 && (lines.words()[1] == "spectral" || lines.words()[1] == "xyz"))
    lines.refuse("a colour given by \"" + std::string(lines.words()[1]) + "\" is not read; expected three numbers");
  if (lines.words().size() == 2) return glm::vec3(lines.number(1));
  return {lines.number(1), lines.number(2), lines.number(3)};
}

void note_unused(const TextLines& lines, const Material& material, UnusedFeatures& unused) {
  const std::string_view key = lines.words()[0];
  if (is_map(key)) unused.add("maps (" + std::string(key) + ") are not used", material.name);
  for (const Unused& feature : kUnused)
    if (key == feature.key && lines.number(lines.words().size() - 1) != feature.neutral) unused.add(feature.what, material.name);
}

/// Blinn-Phong's exponent s = 2 / alpha^2 - 2.
float roughness_of_exponent(double exponent) {
  return static_cast<float>(std::pow(2 / (exponent + 2), 0.25));
}

}  // namespace

Material obj_default_material() {
  Material material;
  material.base_color = glm::vec3(0.6f);
  material.dielectric_f0 = 0;
  return material;
}

std::vector<Material> read_obj_materials(const std::string& path, UnusedFeatures& unused) {
  std::vector<Material> materials;
  bool has_roughness = false;
  for (TextLines lines(path); lines.next();) {
    const std::string_view key = lines.words()[0];
    if (key == "newmtl") {
      materials.push_back(obj_default_material());
      materials.back().name = lines.rest();
      has_roughness = false;
    }
    if (materials.empty()) continue;
    Material& material = materials.back();
    if (key == "Kd") material.base_color = glm::clamp(color(lines), 0.0f, 1.0f);
    if (key == "Ke") material.emissive = glm::max(color(lines), 0.0f);
    if (key == "Ks") material.dielectric_f0 = color(lines) == glm::vec3(0) ? 0.0f : Material{}.dielectric_f0;
    if (key == "Ns" && !has_roughness && lines.number(1) > 0) material.roughness = roughness_of_exponent(lines.number(1));
    if (key == "Pm") material.metallic = static_cast<float>(std::clamp(lines.number(1), 0.0, 1.0));
    if (key == "Pr") material.roughness = static_cast<float>(std::clamp(lines.number(1), 0.0, 1.0)), has_roughness = true;
    note_unused(lines, material, unused);
  }
  return materials;
}

}  // namespace catchlight::render
