// Parts of the glTF reader: accessors as plain arrays, materials with their base colour textures.
#pragma once

// The same as in tiny_gltf.cpp: pictures are decoded elsewhere.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <optional>
#include <span>

#include "catchlight/image.hpp"
#include "render/mesh/mesh.hpp"
#include "render/mesh/unused_features.hpp"

namespace catchlight::render::gltf {

/// The file, and what its errors start with.
struct Document {
  tinygltf::Model model;
  std::string path;
};

/// `components` floats an element, normalised integers mapped to [0, 1] or [-1, 1], sparse values put in. An RGBA accessor read
/// with 3 components drops the fourth. Throws Error for anything out of range.
std::vector<float> read_floats(const Document& document, int accessor, int components);

/// Unsigned integers, such as indices. Throws Error for other component types and anything out of range.
std::vector<std::uint32_t> read_indices(const Document& document, int accessor);

/// The bytes of a buffer view, checked to lie within its buffer.
std::span<const unsigned char> bytes_of(const Document& document, int buffer_view);

/// Remembers the bytes of images in files of their own, to be decoded when needed; those in buffers are where they are.
bool keep_image_bytes(tinygltf::Image* image, int index, std::string* error, std::string* warning, int width, int height,
                      const unsigned char* bytes, int size, void* user);

/// Adds what the document holds and import_gltf does not use: of its materials, meshes, nodes and extensions.
void note_unused(const Document& document, UnusedFeatures& unused);

/// Throws Error where the document cannot be drawn without an extension that is not known.
void check_required_extensions(const Document& document);

/// The material's factors only, extensions specular, ior and emissive_strength included.
Material material_of(const tinygltf::Material& source);

/// A base colour texture, ready to be looked up at texture coordinates.
struct ColorTexture {
  Image image_linear;
  int texture_coordinates = 0;  ///< n of TEXCOORD_n
  int wrap_s = TINYGLTF_TEXTURE_WRAP_REPEAT, wrap_t = TINYGLTF_TEXTURE_WRAP_REPEAT;
  glm::dmat3 uv_transform{1.0};  ///< KHR_texture_transform

  glm::vec3 operator()(const glm::dvec2& uv) const;
};

/// The material's base colour texture; empty where it has none. Throws Error where the picture cannot be decoded.
std::optional<ColorTexture> base_color_texture(const Document& document, const tinygltf::Material& material);

}  // namespace catchlight::render::gltf
