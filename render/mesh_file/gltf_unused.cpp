// What glTF files hold and is not drawn.
#include <algorithm>
#include <array>
#include <cmath>

#include "catchlight/error.hpp"
#include "render/mesh_file/gltf.hpp"

namespace catchlight::render::gltf {
namespace {

constexpr std::array kKnownExtensions{
    "KHR_materials_specular", "KHR_materials_ior",   "KHR_materials_emissive_strength", "KHR_texture_transform",
    "KHR_mesh_quantization",  "KHR_materials_unlit", "EXT_mesh_gpu_instancing",         "KHR_materials_pbrSpecularGlossiness"};

/// What the object is drawn without as well as with, even where the file requires it.
constexpr std::array kBesideTheObject{"KHR_lights_punctual", "EXT_lights_image_based", "EXT_lights_ies",
                                      "KHR_xmp_json_ld",     "KHR_animation_pointer",  "KHR_materials_variants"};

/// What extensions are for, where their names do not say it to everybody.
constexpr std::array<std::array<const char*, 2>, 10> kMeanings{
    {{"KHR_materials_transmission", "transmission is not used: glass is opaque"},
     {"KHR_materials_volume", "volumes are not used: nothing shines through"},
     {"KHR_materials_clearcoat", "clear coat is not used"},
     {"KHR_materials_sheen", "sheen is not used"},
     {"KHR_materials_anisotropy", "anisotropy is not used: highlights are round"},
     {"KHR_materials_iridescence", "iridescence is not used"},
     {"KHR_materials_dispersion", "dispersion is not used"},
     {"KHR_materials_diffuse_transmission", "diffuse transmission is not used: thin sheets are opaque"},
     {"KHR_materials_variants", "variants are not used: the default one is drawn"},
     {"KHR_lights_punctual", "lights are not used: all light comes from the probe"}}};

template <typename List>
bool contains(const List& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

std::string sentence_about(const std::string& extension) {
  for (const auto& [name, meaning] : kMeanings)
    if (extension == name) return std::string(meaning) + " (" + extension + ')';
  return "the glTF extension " + extension + " is not used";
}

/// The material's name, or its number.
std::string name_of(const tinygltf::Material& material, std::size_t index) {
  return material.name.empty() ? std::to_string(index) : material.name;
}

void note_alpha(const tinygltf::Material& material, const std::string& name, UnusedFeatures& unused) {
  const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
  const bool may_be_clear = pbr.baseColorTexture.index >= 0 || (pbr.baseColorFactor.size() == 4 && pbr.baseColorFactor[3] < 1);
  if (material.alphaMode == "MASK" && may_be_clear) unused.add("alphaMode MASK is not used: nothing is cut out", name);
  if (material.alphaMode == "BLEND" && may_be_clear) unused.add("alphaMode BLEND is not used: it is opaque", name);
}

void note_maps(const tinygltf::Material& material, const std::string& name, UnusedFeatures& unused) {
  const auto specular = material.extensions.find("KHR_materials_specular");
  if (specular != material.extensions.end() &&
      (specular->second.Has("specularTexture") || specular->second.Has("specularColorTexture")))
    unused.add("specular maps are not used", name);
}

void note_material(const tinygltf::Material& material, const std::string& name, UnusedFeatures& unused) {
  note_alpha(material, name, unused);
  note_maps(material, name, unused);
  const auto glossy = material.extensions.find("KHR_materials_pbrSpecularGlossiness");
  if (glossy != material.extensions.end() && glossy->second.Has("specularGlossinessTexture"))
    unused.add("specular-glossiness maps are not used, only the factors", name);
  for (const auto& [extension, value] : material.extensions)
    if (!contains(kKnownExtensions, extension)) unused.add(sentence_about(extension), name);
}

void note_shapes(const tinygltf::Model& model, UnusedFeatures& unused) {
  if (!model.animations.empty()) unused.add("animation is not used: the object stays as its nodes place it");
  if (!model.cameras.empty()) unused.add("cameras are not used: the footage has its own");
  if (model.scenes.size() > 1)
    unused.add("of its " + std::to_string(model.scenes.size()) + " scenes only the default one is drawn");
}

}  // namespace

void note_unused(const Document& document, UnusedFeatures& unused) {
  const tinygltf::Model& model = document.model;
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    note_material(model.materials[i], name_of(model.materials[i], i), unused);
  note_shapes(model, unused);
  for (const std::string& extension : model.extensionsUsed) {
    const bool is_a_materials = std::any_of(model.materials.begin(), model.materials.end(),
                                            [&](const auto& material) { return material.extensions.contains(extension); });
    if (!is_a_materials && !contains(kKnownExtensions, extension)) unused.add(sentence_about(extension));
  }
}

void check_required_extensions(const Document& document) {
  for (const std::string& name : document.model.extensionsRequired) {
    if (!contains(kKnownExtensions, name) && !contains(kBesideTheObject, name))
      throw Error(document.path + ": needs the glTF extension " + name + ", which is not supported; export without it");
  }
}

}  // namespace catchlight::render::gltf
