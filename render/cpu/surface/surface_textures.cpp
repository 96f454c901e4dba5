#include "render/cpu/surface/surface_textures.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/util/parallel.hpp"

namespace catchlight::render {
namespace {

constexpr std::size_t kPointsAtOnce = 256;
/// Seen more edge on than this cosine, a pixel covers no more of the surface: it is the surface's own bend that ends it.
constexpr float kMinCosine = 0.02f;

glm::vec3 between_corners(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec2& w) {
  return (1 - w.x - w.y) * a + w.x * b + w.y * c;
}

}  // namespace

SurfaceTextures::SurfaceTextures(const Mesh& mesh, const SurfaceMaterials& materials) : mesh_(mesh), materials_(materials) {
  has_textures_ = mesh.has_textures() && std::ranges::any_of(mesh.materials, &Material::has_textures);
}

SurfaceTextures::Edges SurfaceTextures::edges_of(std::uint32_t triangle) const {
  const std::uint32_t* corner = &mesh_.indices[3 * static_cast<std::size_t>(triangle)];
  const glm::vec3& origin_m = mesh_.vertices[corner[0]].position_m;
  Edges edges{mesh_.vertices[corner[1]].position_m - origin_m, mesh_.vertices[corner[2]].position_m - origin_m, {}};
  edges.normal = glm::cross(edges.to_1_m, edges.to_2_m);
  return edges;
}

glm::vec2 SurfaceTextures::Edges::weights_of(const glm::vec3& step_m) const {
  const float area2 = std::max(glm::dot(normal, normal), 1e-30f);
  return {glm::dot(glm::cross(step_m, to_2_m), normal) / area2, glm::dot(glm::cross(to_1_m, step_m), normal) / area2};
}

/// Linear RGBA; white where the material has no such texture.
glm::vec4 SurfaceTextures::value(const MaterialTexture& use, const Place& place) const {
  if (!use.is_used()) return glm::vec4(1);
  const std::uint32_t* corner = &mesh_.indices[3 * static_cast<std::size_t>(place.triangle)];
  const auto uv = [&](int k) { return mesh_.texture_coordinates[corner[k]].uv[static_cast<std::size_t>(use.set)]; };
  const glm::vec2 origin = uv(0), to_1 = uv(1) - origin, to_2 = uv(2) - origin;
  const glm::mat2 linear(use.uv_transform);
  const auto along = [&](const glm::vec2& weights) { return linear * (weights.x * to_1 + weights.y * to_2); };
  const glm::vec2 at(use.uv_transform * glm::vec3(origin + place.weights.x * to_1 + place.weights.y * to_2, 1));
  return look_up(*mesh_.textures[static_cast<std::size_t>(use.texture)], at, {along(place.along_x), along(place.along_y)});
}

shader_interface::SurfaceMaterial SurfaceTextures::material_at(const Place& place) const {
  const std::uint16_t number = mesh_.triangle_material[place.triangle];
  const Material& material = mesh_.materials[number];
  shader_interface::SurfaceMaterial result = materials_.materials[number];
  const glm::vec3 color(value(material.base_color_texture, place)), emitted(value(material.emissive_texture, place));
  const glm::vec4 rough_metal = value(material.metallic_roughness_texture, place);
  result.base_color_metallic *= glm::vec4(color, rough_metal.b);
  result.emissive_roughness *= glm::vec4(emitted, rough_metal.g);
  result.unlit_color *= glm::vec4(color, 1);
  return result;
}

shader_interface::SurfaceMaterial SurfaceTextures::material_at(std::uint32_t triangle, const glm::vec2& weights,
                                                               float radius_m) const {
  const std::uint16_t number = mesh_.triangle_material[triangle];
  if (!has_textures_ || !mesh_.materials[number].has_textures()) return materials_.materials[number];
  const Edges edges = edges_of(triangle);
  const glm::vec3 along = glm::normalize(edges.to_1_m), across = glm::normalize(glm::cross(edges.normal, edges.to_1_m));
  const float width_m = 2 * radius_m;
  return material_at(Place{triangle, weights, edges.weights_of(width_m * along), edges.weights_of(width_m * across)});
}

/// The pixel's footprint is its square, seen on the triangle's plane.
SurfaceTextures::Place SurfaceTextures::place_of(const FrameView& view, const SurfacePoint& point) const {
  const Edges edges = edges_of(point.triangle);
  const glm::mat3 tag_from_camera(glm::transpose(view.camera_from_tag.rotation));
  const glm::vec3 normal = edges.normal / std::max(glm::length(edges.normal), 1e-30f);
  float facing = glm::dot(normal, point.to_viewer);
  facing = std::copysign(std::max(std::abs(facing), kMinCosine), facing);
  const auto on_plane = [&](const glm::vec3& step_m) {
    return edges.weights_of(step_m - point.to_viewer * (glm::dot(normal, step_m) / facing));
  };
  const auto fx = static_cast<float>(view.camera.fx_px), fy = static_cast<float>(view.camera.fy_px);
  return {point.triangle, point.weights, on_plane(point.depth_m / fx * tag_from_camera[0]),
          on_plane(point.depth_m / fy * tag_from_camera[1])};
}

/// As glTF 2.0 has it (3.9.3): on the back the whole frame is turned round.
glm::vec3 SurfaceTextures::bent_normal(const MaterialTexture& use, const Place& place, const SurfacePoint& point) const {
  const std::uint32_t* corner = &mesh_.indices[3 * static_cast<std::size_t>(place.triangle)];
  const auto tangent = [&](int k) { return mesh_.texture_coordinates[corner[k]].tangent; };
  const float side = point.is_back ? -1.0f : 1.0f;
  const glm::vec3 n = side * point.normal;
  glm::vec3 t = between_corners(glm::vec3(tangent(0)), glm::vec3(tangent(1)), glm::vec3(tangent(2)), place.weights);
  t -= glm::dot(t, n) * n;
  if (!(glm::length(t) > 1e-6f)) return point.normal;
  t = glm::normalize(t);
  const glm::vec3 b = tangent(0).w * glm::cross(n, t);
  const glm::vec3 slope = 2.0f * glm::vec3(value(use, place)) - 1.0f;
  const glm::vec3 bent = slope.x * use.strength * t + slope.y * use.strength * b + std::max(slope.z, 1e-3f) * n;
  return side * glm::normalize(bent);
}

TexturedSurface SurfaceTextures::look_at(const FrameView& view, SurfacePoint& point) const {
  const Material& material = mesh_.materials[point.material];
  const Place place = place_of(view, point);
  TexturedSurface textured{material_at(place), point.normal, 1, material.normal_texture.is_used()};
  if (material.occlusion_texture.is_used())
    textured.occlusion = 1 + material.occlusion_texture.strength * (value(material.occlusion_texture, place).r - 1);
  if (!textured.is_bent) return textured;
  point.normal = bent_normal(material.normal_texture, place, point);
  const float n_v = glm::dot(point.normal, point.to_viewer);
  if (n_v < 0) point.normal = glm::normalize(point.normal - (n_v - 1e-3f) * point.to_viewer);  // what is seen looks this way
  return textured;
}

void SurfaceTextures::apply(const FrameView& view, VisibleSurface& surface) const {
  surface.textured.clear();
  if (!has_textures_) return;
  for (SurfacePoint& point : surface.points)
    if (mesh_.materials[point.material].has_textures()) {
      point.textured = static_cast<std::int32_t>(surface.textured.size());
      surface.textured.emplace_back();
    }
  parallel_for((surface.points.size() + kPointsAtOnce - 1) / kPointsAtOnce, 0, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kPointsAtOnce; i < std::min((chunk + 1) * kPointsAtOnce, surface.points.size()); ++i) {
      SurfacePoint& point = surface.points[i];
      if (point.textured >= 0) surface.textured[static_cast<std::size_t>(point.textured)] = look_at(view, point);
    }
  });
}

}  // namespace catchlight::render
