// Triangle meshes with metallic-roughness materials.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "render/mesh/texture.hpp"

namespace catchlight::render {

/// What opacity does: nothing; cuts out what is less opaque than Material::alpha_cutoff; lets through what is behind.
enum class AlphaMode { opaque, mask, blend };

/// A material of glTF 2.0's metallic-roughness model. Colours are linear Rec. 709. Textures multiply the factors.
struct Material {
  std::string name;
  glm::vec3 base_color{0.8f};
  float metallic = 0.0f;
  float roughness = 1.0f;       ///< perceptual; alpha = roughness^2
  float dielectric_f0 = 0.04f;  ///< ((ior-1)/(ior+1))^2 * KHR_materials_specular.specularFactor
  glm::vec3 emissive{0.0f};     ///< radiance
  glm::vec3 unlit_color{0.0f};  ///< times Vertex::color: the exposed linear value that is added, whatever light and exposure are
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  float opacity = 1.0f;                        ///< times that of the base colour texture
  bool is_double_sided = false;                ///< seen from behind, it is lit there
  MaterialTexture base_color_texture;          ///< times base_color, or unlit_color
  MaterialTexture metallic_roughness_texture;  ///< green times roughness, blue times metallic
  MaterialTexture normal_texture;              ///< tangent space, +y up
  MaterialTexture occlusion_texture;           ///< red
  MaterialTexture emissive_texture;            ///< times emissive

  std::array<MaterialTexture*, 5> texture_uses() {
    return {&base_color_texture, &metallic_roughness_texture, &normal_texture, &occlusion_texture, &emissive_texture};
  }
  bool has_textures() const {
    return base_color_texture.is_used() || metallic_roughness_texture.is_used() || normal_texture.is_used() ||
           occlusion_texture.is_used() || emissive_texture.is_used();
  }
};

struct Vertex {
  glm::vec3 position_m;
  glm::vec3 normal;
  glm::vec3 color{1.0f};  ///< linear, multiplies the material's base colour
};

/// Where a vertex lies in the textures, and which way they run there.
struct TextureCoordinates {
  std::array<glm::vec2, 2> uv{};
  glm::vec4 tangent{0};  ///< along u, length 1; w: 1, or -1 where the normal map's +y is -cross(normal, tangent). 0: not known
};

/// `triangle_material[i]` is the material of triangle i, indices[3i .. 3i+2]. Faces wind counter-clockwise seen from outside.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint16_t> triangle_material;
  std::vector<Material> materials;
  std::vector<TextureCoordinates> texture_coordinates;   ///< one a vertex, or none at all
  std::vector<std::shared_ptr<const Texture>> textures;  ///< of the materials

  bool has_textures() const { return !texture_coordinates.empty(); }
};

/// What lies between two vertices, `share` of the way to the second.
Vertex between(const Vertex& a, const Vertex& b, float share);
TextureCoordinates between(const TextureCoordinates& a, const TextureCoordinates& b, float share);

/// Moves positions p to linear part * p + translation; normals by the inverse transpose, tangents by the linear part.
/// `tag_from_object` is 3 rows of 4. Throws Error where singular.
Mesh transformed(const Mesh& mesh, const glm::dmat4& tag_from_object);

/// Appends `other`; materials and textures are kept apart.
void append(Mesh& mesh, const Mesh& other);

/// What of the mesh lies above z = 0, with the vertices of that only; triangles that cross the plane end on it.
Mesh upper_half(const Mesh& mesh);

/// Splits edges longer than `max_edge_m` (shared edges alike, so no cracks), keeping per-vertex lighting honest on long edges.
/// Stops before exceeding `max_vertices`.
void subdivide_long_edges(Mesh& mesh, double max_edge_m, std::size_t max_vertices);

}  // namespace catchlight::render
