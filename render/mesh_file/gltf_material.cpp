#include <algorithm>
#include <cmath>
#include <limits>

#include "catchlight/color.hpp"
#include "render/mesh_file/gltf.hpp"

namespace catchlight::render::gltf {

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

double number(const tinygltf::Value* object, const char* key, double otherwise) {
  if (!object || !object->Has(key) || !object->Get(key).IsNumber()) return otherwise;
  return object->Get(key).GetNumberAsDouble();
}

int whole_number(const tinygltf::Value* object, const char* key, int otherwise) {
  const double value = number(object, key, otherwise);
  return std::abs(value) <= std::numeric_limits<int>::max() ? static_cast<int>(value) : otherwise;
}

double number_at(const tinygltf::Value* object, const char* key, int index, double otherwise) {
  if (!object || !object->Has(key) || !object->Get(key).IsArray() || index >= static_cast<int>(object->Get(key).ArrayLen()))
    return otherwise;
  return object->Get(key).Get(index).GetNumberAsDouble();
}

namespace {

// KHR_materials_ior: 0 stands for an infinite index, a mirror. KHR_materials_specular scales it, here by its colour's luminance.
float dielectric_f0(const tinygltf::Material& source) {
  const tinygltf::Value* specular = extension(source.extensions, "KHR_materials_specular");
  const double ior = number(extension(source.extensions, "KHR_materials_ior"), "ior", 1.5);
  const double root = ior > 0 ? (ior - 1) / (ior + 1) : 1.0;
  double color = 0;
  for (int c = 0; c < 3; ++c) color += kLuminanceWeights[c] * number_at(specular, "specularColorFactor", c, 1.0);
  return static_cast<float>(std::clamp(root * root * number(specular, "specularFactor", 1.0) * color, 0.0, 1.0));
}

glm::vec3 factor(const std::vector<double>& values, const glm::vec3& otherwise) {
  return values.size() >= 3 ? glm::vec3(values[0], values[1], values[2]) : otherwise;
}

// KHR_materials_unlit: the base colour alone counts, as it is.
Material unlit(const Material& lit) {
  Material material = lit;
  material.base_color = material.emissive = glm::vec3(0);
  material.metallic = material.dielectric_f0 = 0;
  material.roughness = 1;
  material.unlit_color = lit.base_color;
  return material;
}

/// The metalness with which a dielectric's F0 and the base colour give this diffuse and specular brightness (Khronos's conversion
/// of specular-glossiness, KHR_materials_pbrSpecularGlossiness, appendix B).
double metalness(double diffuse, double specular, double one_minus_specular) {
  constexpr double kDielectric = 0.04;
  if (specular < kDielectric) return 0;
  const double b = diffuse * one_minus_specular / (1 - kDielectric) + specular - 2 * kDielectric;
  return std::clamp((std::sqrt(std::max(b * b - 4 * kDielectric * (kDielectric - specular), 0.0)) - b) / (2 * kDielectric), 0.0,
                    1.0);
}

/// What the eye takes for brightness, as that conversion has it.
double perceived(const glm::dvec3& color) {
  return std::sqrt(0.299 * color.r * color.r + 0.587 * color.g * color.g + 0.114 * color.b * color.b);
}

// Without metal the conversion is exact but for coloured reflections: diffuse stays, and specular is the F0.
void convert_glossy(const tinygltf::Value& glossy, Material& material) {
  const auto color = [&](const char* key) {
    return glm::dvec3(number_at(&glossy, key, 0, 1), number_at(&glossy, key, 1, 1), number_at(&glossy, key, 2, 1));
  };
  const glm::dvec3 diffuse = glm::clamp(color("diffuseFactor"), 0.0, 1.0),
                   specular = glm::clamp(color("specularFactor"), 0.0, 1.0);
  const double strongest = std::max({specular.r, specular.g, specular.b}), kDielectric = 0.04;
  const double metallic = metalness(perceived(diffuse), perceived(specular), 1 - strongest);
  const glm::dvec3 from_diffuse = diffuse * (1 - strongest) / (1 - kDielectric) / std::max(1 - metallic, 1e-6),
                   from_specular = (specular - kDielectric * (1 - metallic)) / std::max(metallic, 1e-6);
  material.base_color = glm::vec3(glm::clamp(glm::mix(from_diffuse, from_specular, metallic * metallic), 0.0, 1.0));
  material.metallic = static_cast<float>(metallic);
  material.roughness = static_cast<float>(std::clamp(1 - number(&glossy, "glossinessFactor", 1), 0.0, 1.0));
  material.dielectric_f0 = static_cast<float>(std::min(strongest, kDielectric));
}

}  // namespace

bool keep_image_bytes(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size,
                      void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

Material material_of(const tinygltf::Material& source) {
  const auto unit = [](double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); };
  Material material;
  material.name = source.name;
  material.base_color = glm::clamp(factor(source.pbrMetallicRoughness.baseColorFactor, glm::vec3(1)), 0.0f, 1.0f);
  material.metallic = unit(source.pbrMetallicRoughness.metallicFactor);
  material.roughness = unit(source.pbrMetallicRoughness.roughnessFactor);
  material.dielectric_f0 = dielectric_f0(source);
  const tinygltf::Value* glossy = extension(source.extensions, "KHR_materials_pbrSpecularGlossiness");
  if (glossy) convert_glossy(*glossy, material);
  const double strength = number(extension(source.extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
  material.emissive = glm::max(factor(source.emissiveFactor, glm::vec3(0)) * static_cast<float>(strength), 0.0f);
  if (source.alphaMode == "MASK") material.alpha_mode = AlphaMode::mask;
  if (source.alphaMode == "BLEND") material.alpha_mode = AlphaMode::blend;
  material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
  const std::vector<double>& color = source.pbrMetallicRoughness.baseColorFactor;
  if (material.alpha_mode != AlphaMode::opaque && color.size() == 4) material.opacity = unit(color[3]);
  if (material.alpha_mode != AlphaMode::opaque && glossy) material.opacity = unit(number_at(glossy, "diffuseFactor", 3, 1));
  material.is_double_sided = source.doubleSided;
  if (extension(source.extensions, "KHR_materials_unlit")) return unlit(material);
  return material;
}

}  // namespace catchlight::render::gltf
