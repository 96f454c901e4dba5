#include "render/cpu/mirror/mirror_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shaders/shading.h"

namespace catchlight::render {
namespace {

constexpr int kMaxSkins = 4;

}  // namespace

/// A ray on its way.
struct MirrorRays::Walk {
  std::size_t ray;  ///< which of trace()'s
  glm::vec3 origin_m, direction;
  glm::vec3 through{1};  ///< what is left of light that arrives from there
  float spread, roughness;
};

struct MirrorRays::Batch {
  std::vector<Walk> walks, ends;  ///< on their way on the object; past it at last
  RayStream stream, behind_skin;
  std::vector<std::size_t> again;
};

MirrorRays::MirrorRays(const Mesh& mesh, const RayScene& scene, const SurfaceTextures& textures, const BrdfTable& brdf,
                       float skin_m)
    : mesh_(mesh), scene_(scene), textures_(textures), brdf_(brdf), skin_m_(skin_m) {}

void MirrorRays::set_frame(const Surroundings& around, const VertexLight& light, const glm::vec3& exposure) {
  around_ = &around;
  light_ = light;
  exposure_ = exposure;
}

/// Finds what each walk meets next, beyond the skin.
void MirrorRays::find_hits(Batch& batch, Coherence coherence) const {
  RayStream& stream = batch.stream;
  stream.resize(batch.walks.size());
  for (std::size_t i = 0; i < batch.walks.size(); ++i)
    stream.set(i, batch.walks[i].origin_m, batch.walks[i].direction, 0, std::numeric_limits<float>::infinity());
  scene_.closest_hits(stream, coherence);
  for (int round = 0; round < kMaxSkins; ++round) {
    batch.again.clear();
    for (std::size_t i = 0; i < stream.size(); ++i)
      if (stream.meets(i) && !stream.is_front_facing(i) && stream.far[i] <= skin_m_) batch.again.push_back(i);
    if (batch.again.empty()) return;
    RayStream& behind = batch.behind_skin;
    behind.resize(batch.again.size());
    for (std::size_t k = 0; k < batch.again.size(); ++k) {
      const std::size_t i = batch.again[k];
      behind.set(k, stream.origin_m(i), stream.direction(i), stream.far[i] * 1.0001f + 1e-7f * skin_m_,
                 std::numeric_limits<float>::infinity());
    }
    scene_.closest_hits(behind, Coherence::incoherent);
    for (std::size_t k = 0; k < batch.again.size(); ++k) {
      const std::size_t i = batch.again[k];
      stream.triangle[i] = behind.triangle[k], stream.far[i] = behind.far[k];
      stream.u[i] = behind.u[k], stream.v[i] = behind.v[k];
      stream.normal_x[i] = behind.normal_x[k], stream.normal_y[i] = behind.normal_y[k], stream.normal_z[i] = behind.normal_z[k];
    }
  }
}

/// Adds what the walk sees where it meets the object, and turns it to where it goes from there. Whether it may meet the object
/// again.
bool MirrorRays::meet(Walk& walk, const RayStream& hits, std::size_t at, MirrorRay& ray, int bounce) const {
  const std::uint32_t triangle = hits.triangle[at], *corner = &mesh_.indices[3 * static_cast<std::size_t>(triangle)];
  const glm::vec3 w(1 - hits.u[at] - hits.v[at], hits.u[at], hits.v[at]);
  const auto m = textures_.material_at(triangle, {hits.u[at], hits.v[at]}, 0.5f * walk.spread * hits.far[at]);
  glm::vec3 normal(0), color(0), irradiance_over_pi(0);
  for (int k = 0; k < 3; ++k) {
    const Vertex& vertex = mesh_.vertices[corner[k]];
    normal += w[k] * vertex.normal, color += w[k] * vertex.color,
        irradiance_over_pi += w[k] * light_.irradiance_over_pi[corner[k]];
    if (!light_.direct_over_pi.empty()) irradiance_over_pi += w[k] * light_.direct_over_pi[corner[k]];
  }
  normal /= std::max(glm::length(normal), 1e-20f);
  const float n_v = -glm::dot(normal, walk.direction), roughness = m.emissive_roughness.w;
  const glm::vec4 factor = shading::mirror_factor(m, color, brdf_.at(n_v, roughness));
  ray.radiance += walk.through * (irradiance_over_pi * shading::diffuse_albedo(m, color) * factor.w +
                                  shading::emitted_radiance(m, color, exposure_));
  walk.through *= glm::vec3(factor);
  const glm::vec3 position = walk.origin_m + hits.far[at] * walk.direction;
  const bool follows =
      bounce < shading::kMoreBounces && std::max({factor.x, factor.y, factor.z}) >= shading::kMinFollowed && n_v > 0;
  walk.origin_m = position;
  if (!follows) {
    walk.direction = glm::reflect(walk.direction, normal);
    walk.spread += roughness * roughness, walk.roughness = shading::wider(roughness, walk.roughness);
    return false;
  }
  walk.direction = shading::mirrored_way(walk.direction, normal, roughness, shading::way_from_surface(ray.index, bounce));
  walk.origin_m = start(position, normal);
  const float share = shading::kFurtherShare * roughness;
  walk.spread += share * share;
  walk.roughness = shading::wider(share, walk.roughness);
  return true;
}

void MirrorRays::trace(std::span<MirrorRay> rays) const {
  thread_local Batch batch;
  batch.walks.clear(), batch.ends.clear();
  for (std::size_t i = 0; i < rays.size(); ++i)
    batch.walks.push_back({i, rays[i].origin_m, rays[i].direction, glm::vec3(1), rays[i].spread, rays[i].roughness});
  for (int bounce = 0; !batch.walks.empty(); ++bounce) {
    find_hits(batch, bounce == 0 ? Coherence::coherent : Coherence::incoherent);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < batch.walks.size(); ++i) {
      Walk walk = batch.walks[i];
      MirrorRay& ray = rays[walk.ray];
      if (batch.stream.meets(i)) ray.meets_object = true;
      if (batch.stream.meets(i) && meet(walk, batch.stream, i, ray, bounce)) {
        batch.walks[kept++] = walk;
      } else if (ray.meets_object) {
        batch.ends.push_back(walk);
      }
    }
    batch.walks.resize(kept);
  }
  const auto find = [&](std::size_t i) {
    const Walk& walk = batch.ends[i];
    return around_->find(walk.origin_m, walk.direction, walk.spread, walk.roughness, true);
  };
  Surroundings::for_each_target(batch.ends.size(), find, [&](std::size_t i, const Surroundings::Target& target) {
    rays[batch.ends[i].ray].radiance += batch.ends[i].through * around_->radiance(target);
  });
}

void MirrorRays::look(std::span<MirrorRay> rays) const {
  thread_local Batch batch;
  batch.walks.clear();
  for (std::size_t i = 0; i < rays.size(); ++i)
    batch.walks.push_back({i, rays[i].origin_m, rays[i].direction, glm::vec3(1), 0, 0});
  find_hits(batch, Coherence::coherent);
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].meets_object = batch.stream.meets(i);
}

}  // namespace catchlight::render
