// Textures of glTF's materials.
#include <algorithm>
#include <cmath>

#include "catchlight/error.hpp"
#include "render/mesh_file/gltf.hpp"

namespace catchlight::render::gltf {
namespace {

constexpr int kMaxSets = 2;  // of texture coordinates, as TextureCoordinates has

template <typename List>
bool is_within(int index, const List& list) {
  return index >= 0 && static_cast<std::size_t>(index) < list.size();
}

TextureWrap wrap_of(int mode) {
  return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? TextureWrap::clamp
         : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::mirror
                                                         : TextureWrap::repeat;
}

// KHR_texture_transform: translation * rotation * scale, with the extension's sense of rotation.
glm::mat3 uv_transform(const tinygltf::Value* transform) {
  const double turn = number(transform, "rotation", 0), c = std::cos(turn), s = std::sin(turn);
  const double scale_u = number_at(transform, "scale", 0, 1), scale_v = number_at(transform, "scale", 1, 1);
  return {glm::vec3(c * scale_u, -s * scale_u, 0), glm::vec3(s * scale_v, c * scale_v, 0),
          glm::vec3(number_at(transform, "offset", 0, 0), number_at(transform, "offset", 1, 0), 1)};
}

TextureLevel decode(const Document& document, int index, const WarningHandler& warn) {
  const tinygltf::Image& source = document.model.images[index];
  const std::span<const unsigned char> bytes =
      source.bufferView >= 0 ? bytes_of(document, source.bufferView) : std::span(source.image);
  const std::string name = !source.uri.empty()    ? source.uri
                           : !source.name.empty() ? source.name
                                                  : "image " + std::to_string(index);
  if (bytes.empty() && !source.uri.empty()) throw Error(document.path + ": its texture \"" + name + "\" is not there");
  try {
    return decode_texture(bytes, document.path + ": texture \"" + name + '"', warn);
  } catch (const Error& error) {
    throw Error(document.path + ": the texture \"" + name + "\" cannot be decoded: it " + error.what());
  }
}

}  // namespace

template <typename Info>
MaterialTexture MaterialReader::texture(const Info& info, const char* what, bool is_srgb, const std::string& material) {
  if (info.index < 0) return {};
  const tinygltf::Model& model = document_.model;
  const std::string subject = document_.path + ": the " + what + " texture of material \"" + material + '"';
  const bool is_there = is_within(info.index, model.textures);
  if (is_there && model.textures[info.index].source < 0 && !model.textures[info.index].extensions.empty()) {
    throw Error(subject + " is in the format of " + model.textures[info.index].extensions.begin()->first +
                ", which is not read; export with textures as PNG or JPEG");
  }
  if (!is_there || !is_within(model.textures[info.index].source, model.images)) throw Error(subject + " has no picture");
  const tinygltf::Texture& source = model.textures[info.index];
  TextureUse use{is_srgb, {}};
  if (is_within(source.sampler, model.samplers))
    use.wrap = {wrap_of(model.samplers[source.sampler].wrapS), wrap_of(model.samplers[source.sampler].wrapT)};
  const tinygltf::Image& image = model.images[source.source];
  MaterialTexture result;
  result.texture = textures_.number_of("image " + std::to_string(source.source) + (image.uri.empty() ? "" : " " + image.uri), use,
                                       [&] { return decode(document_, source.source, warn_); });
  const tinygltf::Value* transform = extension(info.extensions, "KHR_texture_transform");
  result.set = whole_number(transform, "texCoord", info.texCoord);
  result.uv_transform = uv_transform(transform);
  return result;
}

void MaterialReader::add_textures(const tinygltf::Material& source, Material& material) {
  const std::string& name = material.name;
  material.base_color_texture = texture(source.pbrMetallicRoughness.baseColorTexture, "base colour", true, name);
  const tinygltf::Value* glossy = extension(source.extensions, "KHR_materials_pbrSpecularGlossiness");
  if (glossy && glossy->Has("diffuseTexture")) {
    tinygltf::TextureInfo diffuse;
    diffuse.index = whole_number(&glossy->Get("diffuseTexture"), "index", -1);
    diffuse.texCoord = whole_number(&glossy->Get("diffuseTexture"), "texCoord", 0);
    material.base_color_texture = texture(diffuse, "diffuse", true, name);
  }
  if (extension(source.extensions, "KHR_materials_unlit")) return;
  material.metallic_roughness_texture =
      texture(source.pbrMetallicRoughness.metallicRoughnessTexture, "metallic-roughness", false, name);
  material.normal_texture = texture(source.normalTexture, "normal", false, name);
  material.normal_texture.strength = static_cast<float>(source.normalTexture.scale);
  material.occlusion_texture = texture(source.occlusionTexture, "occlusion", false, name);
  material.occlusion_texture.strength = std::clamp(static_cast<float>(source.occlusionTexture.strength), 0.0f, 1.0f);
  material.emissive_texture = texture(source.emissiveTexture, "emissive", true, name);
}

TexturedMaterial MaterialReader::read(const tinygltf::Material& source, const tinygltf::Primitive& primitive) {
  TexturedMaterial result{material_of(source), {}};
  add_textures(source, result.material);
  for (MaterialTexture* use : result.material.texture_uses()) {
    if (!use->is_used()) continue;
    const auto known = std::find(result.sets.begin(), result.sets.end(), use->set);
    const std::string name = "TEXCOORD_" + std::to_string(use->set);
    if (!primitive.attributes.contains(name)) {
      unused_.add("there are no texture coordinates " + name + ": textures that need them are left out", source.name);
      *use = {};
    } else if (known == result.sets.end() && result.sets.size() == kMaxSets) {
      unused_.add("a third set of texture coordinates is not used: textures that need it are left out", source.name);
      *use = {};
    } else {
      use->set = static_cast<int>(known - result.sets.begin());
      if (known == result.sets.end()) result.sets.push_back(std::stoi(name.substr(9)));
    }
  }
  return result;
}

}  // namespace catchlight::render::gltf
