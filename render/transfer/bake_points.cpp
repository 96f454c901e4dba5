#include "render/transfer/bake_points.hpp"

#include <algorithm>

#include "render/mesh/base_color.hpp"
#include "render/mesh/bounds.hpp"

namespace catchlight::render {
namespace {

// Rays start this share of the mesh's size above the surface: a hundred times the rounding of its coordinates, a hundredth of a
// pixel.
constexpr float kLift = 1e-5f;

std::vector<char> diffuse_vertices(const Mesh& mesh, const std::vector<glm::vec3>& albedo) {
  std::vector<char> is_diffuse(mesh.vertices.size());
  for (std::size_t v = 0; v < albedo.size(); ++v) is_diffuse[v] = albedo[v] != glm::vec3(0);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.materials[mesh.triangle_material[i / 3]].has_textures()) is_diffuse[mesh.indices[i]] = 1;
  return is_diffuse;
}

/// Links those rays that are among the first, or those that are not.
void link_surfaces(const PointRays& point_rays, int first, bool is_first, LightLinks& links) {
  const RayStream& rays = point_rays.rays();
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (!rays.meets(k) || !rays.is_front_facing(k) || point_rays.is_among_first(k, first) != is_first) continue;
    const float share = point_rays.weights()[k], u = rays.u[k], v = rays.v[k];
    links.add_surface({rays.triangle[k], {share * (1 - u - v), share * u, share * v}});
  }
}

}  // namespace

BakePoints::BakePoints(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options)
    : mesh_(mesh_tag),
      grid_(grid),
      options_(options),
      scene_(mesh_tag),
      albedo_(vertex_diffuse_albedos(mesh_tag)),
      is_diffuse_(diffuse_vertices(mesh_tag, albedo_)) {
  const Bounds bounds = bounds_of(mesh_tag);
  middle_m_ = bounds.middle_m();
  radius_m_ = bounds.diagonal_m() * 0.5f;
  lift_m_ = kLift * 2 * radius_m_;
  receiver_sends_back_ = options.bounces > 0 && grid.points() > 0 && options.receiver_albedo.known();
}

void BakePoints::send_from_vertex(std::size_t v, PointRays& rays) const {
  const Vertex& vertex = mesh_.vertices[v];
  glm::vec3 origin_m = vertex.position_m + lift_m_ * glm::normalize(vertex.normal);
  if (receiver_sends_back_) origin_m.z = std::max(origin_m.z, lift_m_);
  rays.send_over_hemisphere(origin_m, vertex.normal, seed_of(vertex.position_m, vertex.normal, options_.seed));
}

void BakePoints::send_from_receiver(std::size_t p, PointRays& rays) const {
  const glm::vec3 origin_m(grid_.place_m(p), lift_m_);
  rays.send_at_ball(origin_m, middle_m_, radius_m_, seed_of(origin_m, glm::vec3(0, 0, 1), options_.seed));
}

// Calls visit(place, ray) for the rays that meet the receiver, and where they do.
template <typename Visit>
void BakePoints::for_rays_to_receiver(const PointRays& point_rays, const Visit& visit) const {
  if (!receiver_sends_back_) return;
  const RayStream& rays = point_rays.rays();
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (rays.meets(k) || !(rays.direction_z[k] < 0)) continue;
    const glm::vec3 origin_m = rays.origin_m(k), direction = rays.direction(k);
    visit(glm::vec2(origin_m) - origin_m.z / direction.z * glm::vec2(direction), k);
  }
}

void BakePoints::link_vertex(const PointRays& rays, int first, LightLinks& links) const {
  for (const bool is_first : {true, false}) {
    link_surfaces(rays, first, is_first, links);
    for_rays_to_receiver(rays, [&](const glm::vec2& place_m, std::size_t k) {
      if (rays.is_among_first(k, first) != is_first) return;
      if (const auto p = grid_.nearest(place_m)) links.add_receiver(*p, rays.weights()[k]);
    });
    links.end_part();
  }
}

void BakePoints::link_receiver(const PointRays& rays, int first, LightLinks& links) const {
  for (const bool is_first : {true, false}) {
    link_surfaces(rays, first, is_first, links);
    links.end_part();
  }
}

glm::vec3 BakePoints::receiver_correction(const PointRays& rays) const {
  glm::vec3 correction(0);
  for_rays_to_receiver(rays, [&](const glm::vec2& place_m, std::size_t k) {
    correction -= rays.weights()[k] * options_.receiver_albedo.towards(rays.rays().direction(k));
    if (!grid_.nearest(place_m)) correction += rays.weights()[k] * options_.receiver_albedo.at(place_m);
  });
  return correction;
}

}  // namespace catchlight::render
