#include "render/mesh/base_color.hpp"

#include <cmath>

namespace catchlight::render {
namespace {

constexpr int kNone = -1;

/// A vertex is of the material of the first triangle that has it.
std::vector<int> materials_of_vertices(const Mesh& mesh) {
  std::vector<int> materials(mesh.vertices.size(), kNone);
  for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
    int& material = materials[mesh.indices[corner]];
    if (material == kNone) material = mesh.triangle_material[corner / 3];
  }
  return materials;
}

glm::vec2 place_in(const MaterialTexture& use, const TextureCoordinates& vertex) {
  return {use.uv_transform * glm::vec3(vertex.uv[static_cast<std::size_t>(use.set)], 1)};
}

glm::vec3 texture_color(const Mesh& mesh, const MaterialTexture& use, std::size_t vertex, const TextureFootprint& footprint) {
  if (!use.is_used() || !mesh.has_textures()) return glm::vec3(1);
  return look_up(*mesh.textures[static_cast<std::size_t>(use.texture)], place_in(use, mesh.texture_coordinates[vertex]),
                 footprint);
}

/// As wide as the edges at the vertex are long in the texture, along each of its axes: of edges that run in all directions the
/// root of the mean square along an axis is 1/sqrt(2) of their length.
std::vector<TextureFootprint> footprints(const Mesh& mesh) {
  std::vector<glm::vec2> squares(mesh.vertices.size(), glm::vec2(0));
  std::vector<float> counts(mesh.vertices.size(), 0.0f);
  for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
    const MaterialTexture& use = mesh.materials[mesh.triangle_material[corner / 3]].base_color_texture;
    if (!use.is_used()) continue;
    const std::uint32_t here = mesh.indices[corner], next = mesh.indices[corner % 3 == 2 ? corner - 2 : corner + 1];
    const glm::vec2 edge = place_in(use, mesh.texture_coordinates[next]) - place_in(use, mesh.texture_coordinates[here]);
    for (const std::uint32_t end : {here, next}) squares[end] += edge * edge, counts[end] += 1;
  }
  std::vector<TextureFootprint> result(mesh.vertices.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    const glm::vec2 width = glm::sqrt(2.0f * squares[v] / std::max(counts[v], 1.0f));
    result[v] = {{width.x, 0}, {0, width.y}};
  }
  return result;
}

}  // namespace

std::vector<glm::vec3> vertex_base_colors(const Mesh& mesh) {
  const std::vector<int> materials = materials_of_vertices(mesh);
  const std::vector<TextureFootprint> areas = mesh.has_textures() ? footprints(mesh) : std::vector<TextureFootprint>();
  std::vector<glm::vec3> colors(mesh.vertices.size(), glm::vec3(0));
  for (std::size_t v = 0; v < colors.size(); ++v) {
    if (materials[v] == kNone) continue;
    const Material& material = mesh.materials[static_cast<std::size_t>(materials[v])];
    colors[v] = material.base_color * mesh.vertices[v].color;
    if (mesh.has_textures()) colors[v] *= texture_color(mesh, material.base_color_texture, v, areas[v]);
  }
  return colors;
}

std::vector<glm::vec3> vertex_diffuse_albedos(const Mesh& mesh) {
  const std::vector<int> materials = materials_of_vertices(mesh);
  std::vector<glm::vec3> albedos = vertex_base_colors(mesh);
  for (std::size_t v = 0; v < albedos.size(); ++v) {
    if (materials[v] == kNone) continue;
    const Material& material = mesh.materials[static_cast<std::size_t>(materials[v])];
    albedos[v] *= 1 - material.metallic * texture_color(mesh, material.metallic_roughness_texture, v, {}).b;
  }
  return albedos;
}

void fold_base_color_textures(Mesh& mesh) {
  const std::vector<int> materials = materials_of_vertices(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (materials[v] == kNone) continue;
    const Material& material = mesh.materials[static_cast<std::size_t>(materials[v])];
    mesh.vertices[v].color *= texture_color(mesh, material.base_color_texture, v, {});
  }
  for (Material& material : mesh.materials)
    for (MaterialTexture* use : material.texture_uses()) *use = {};
  mesh.texture_coordinates.clear();
  mesh.textures.clear();
}

}  // namespace catchlight::render
