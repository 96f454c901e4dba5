#include <algorithm>
#include <cmath>

#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/image/picture_file.hpp"
#include "render/mesh/gltf.hpp"

namespace catchlight::render::gltf {
namespace {

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

double number(const tinygltf::Value* object, const char* key, double otherwise) {
  if (!object || !object->Has(key) || !object->Get(key).IsNumber()) return otherwise;
  return object->Get(key).GetNumberAsDouble();
}

double number_at(const tinygltf::Value* object, const char* key, int index, double otherwise) {
  if (!object || !object->Has(key) || !object->Get(key).IsArray() || index >= static_cast<int>(object->Get(key).ArrayLen()))
    return otherwise;
  return object->Get(key).Get(index).GetNumberAsDouble();
}

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

int wrapped(int i, int size, int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return std::clamp(i, 0, size - 1);
  const int period = mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? 2 * size : size;
  const int inside = ((i % period) + period) % period;
  return inside < size ? inside : 2 * size - 1 - inside;
}

// 8-bit colour textures are sRGB (glTF 2.0, 3.9.2).
Image decode(const Document& document, const tinygltf::Image& source) {
  const std::span<const unsigned char> bytes =
      source.bufferView >= 0 ? bytes_of(document, source.bufferView) : std::span(source.image);
  const std::string name = source.uri.empty() ? source.name : source.uri;
  if (bytes.empty() && !source.uri.empty()) throw Error(document.path + ": its texture \"" + name + "\" is not there");
  cv::Mat decoded;
  try {
    decoded = decode_picture(bytes, PictureDepth::eight_bits);
  } catch (const Error& error) {
    throw Error(document.path + ": the texture \"" + name + "\" cannot be decoded: it " + error.what());
  }
  Image image(decoded.cols, decoded.rows);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto& bgr = decoded.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(linear_from_srgb(bgr[2 - c] / 255.0));
    }
  }
  return image;
}

// KHR_texture_transform: translation * rotation * scale, with the extension's sense of rotation.
glm::dmat3 uv_transform(const tinygltf::Value* transform) {
  const double turn = number(transform, "rotation", 0), c = std::cos(turn), s = std::sin(turn);
  const double scale_u = number_at(transform, "scale", 0, 1), scale_v = number_at(transform, "scale", 1, 1);
  return {glm::dvec3(c * scale_u, -s * scale_u, 0), glm::dvec3(s * scale_v, c * scale_v, 0),
          glm::dvec3(number_at(transform, "offset", 0, 0), number_at(transform, "offset", 1, 0), 1)};
}

// KHR_materials_unlit: the base colour alone counts, as it is.
Material unlit(const Material& lit) {
  Material material;
  material.name = lit.name;
  material.base_color = glm::vec3(0);
  material.dielectric_f0 = 0;
  material.unlit_color = lit.base_color;
  return material;
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
  const double strength = number(extension(source.extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
  material.emissive = glm::max(factor(source.emissiveFactor, glm::vec3(0)) * static_cast<float>(strength), 0.0f);
  if (extension(source.extensions, "KHR_materials_unlit")) return unlit(material);
  return material;
}

glm::vec3 ColorTexture::operator()(const glm::dvec2& uv) const {
  const glm::dvec3 at = uv_transform * glm::dvec3(uv, 1);
  // Beyond a million repeats a float has no fraction left: the place within the texture is then arbitrary, but must stay an int.
  const double x = std::clamp(at.x, -1e6, 1e6) * image_linear.width - 0.5,
               y = std::clamp(at.y, -1e6, 1e6) * image_linear.height - 0.5;
  if (!std::isfinite(x) || !std::isfinite(y)) return glm::vec3(1);
  const double left = std::floor(x), top = std::floor(y);
  const auto texel = [&](int dx, int dy) {
    const auto index = [](double start, int step, int size, int mode) {
      return wrapped(static_cast<int>(std::fmod(start, 2.0 * size)) + step, size, mode);
    };
    const bool clamp_s = wrap_s == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE, clamp_t = wrap_t == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    const float* value = image_linear.pixel(
        index(clamp_s ? std::clamp(left, -1.0, image_linear.width - 1.0) : left, dx, image_linear.width, wrap_s),
        index(clamp_t ? std::clamp(top, -1.0, image_linear.height - 1.0) : top, dy, image_linear.height, wrap_t));
    return glm::vec3(value[0], value[1], value[2]);
  };
  const float right = static_cast<float>(x - left), down = static_cast<float>(y - top);
  return glm::mix(glm::mix(texel(0, 0), texel(1, 0), right), glm::mix(texel(0, 1), texel(1, 1), right), down);
}

std::optional<ColorTexture> base_color_texture(const Document& document, const tinygltf::Material& material) {
  const tinygltf::TextureInfo& info = material.pbrMetallicRoughness.baseColorTexture;
  if (info.index < 0) return std::nullopt;
  const tinygltf::Model& model = document.model;
  const auto within = [](int index, const auto& list) { return index >= 0 && static_cast<std::size_t>(index) < list.size(); };
  const bool is_there = within(info.index, model.textures);
  if (is_there && model.textures[info.index].source < 0 && !model.textures[info.index].extensions.empty()) {
    throw Error(document.path + ": the base colour texture of material \"" + material.name + "\" is in the format of " +
                model.textures[info.index].extensions.begin()->first +
                ", which is not read; export with textures as PNG or JPEG");
  }
  if (!is_there || !within(model.textures[info.index].source, model.images)) {
    throw Error(document.path + ": the base colour texture of material \"" + material.name + "\" has no picture");
  }
  ColorTexture texture;
  const tinygltf::Texture& source = model.textures[info.index];
  texture.image_linear = decode(document, model.images[source.source]);
  if (within(source.sampler, model.samplers)) {
    texture.wrap_s = model.samplers[source.sampler].wrapS;
    texture.wrap_t = model.samplers[source.sampler].wrapT;
  }
  const tinygltf::Value* transform = extension(info.extensions, "KHR_texture_transform");
  texture.texture_coordinates = static_cast<int>(number(transform, "texCoord", info.texCoord));
  texture.uv_transform = uv_transform(transform);
  return texture;
}

}  // namespace catchlight::render::gltf
