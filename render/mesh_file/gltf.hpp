// Parts of the glTF reader: accessors as plain arrays, materials with their textures.
#pragma once

// The same as in tiny_gltf.cpp: pictures are decoded elsewhere.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <span>

#include "catchlight/error.hpp"
#include "render/mesh/mesh.hpp"
#include "render/mesh_file/texture_file.hpp"
#include "render/mesh_file/unused_features.hpp"

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

/// The material's factors and alpha mode; extensions specular, ior, emissive_strength and unlit are included.
Material material_of(const tinygltf::Material& source);

/// A material for the primitives that have certain texture coordinates.
struct TexturedMaterial {
  Material material;
  std::vector<int> sets;  ///< n of the TEXCOORD_n that are the vertices' first and second set
};

/// Reads materials with their textures.
class MaterialReader {
 public:
  /// Adds to `textures`, and to `unused` what cannot be used.
  MaterialReader(const Document& document, std::vector<std::shared_ptr<const Texture>>& textures, UnusedFeatures& unused,
                 const WarningHandler& warn)
      : document_(document), textures_(textures), unused_(unused), warn_(warn) {}

  /// Leaves out textures for which the primitive has no texture coordinates. Throws Error where a picture cannot be decoded.
  TexturedMaterial read(const tinygltf::Material& source, const tinygltf::Primitive& primitive);

 private:
  template <typename Info>
  MaterialTexture texture(const Info& info, const char* what, bool is_srgb, const std::string& material);
  void add_textures(const tinygltf::Material& source, Material& material);

  const Document& document_;
  TextureList textures_;
  UnusedFeatures& unused_;
  const WarningHandler& warn_;
};

/// A member of the material's, or texture's, extensions; nullptr where it has none of that name.
const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name);

/// A number in an object that may be missing (nullptr), or in an array in it.
double number(const tinygltf::Value* object, const char* key, double otherwise);
int whole_number(const tinygltf::Value* object, const char* key, int otherwise);  ///< otherwise too where it fits no int
double number_at(const tinygltf::Value* object, const char* key, int index, double otherwise);

}  // namespace catchlight::render::gltf
