// Rays that leave a mirroring surface: what those that meet the object again see of it.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/cpu/mirror/brdf_table.hpp"
#include "render/cpu/mirror/surroundings.hpp"
#include "render/cpu/surface/surface_textures.hpp"
#include "render/mesh/mesh.hpp"
#include "render/rays/ray_scene.hpp"
#include "render/surface_material.hpp"

namespace catchlight::render {

/// The light that arrives at the vertices; a value each.
struct VertexLight {
  std::span<const glm::vec3> irradiance_over_pi;   ///< by the transfer
  std::span<const glm::vec3> direct_over_pi = {};  ///< irradiance / pi of the lights that are split off; none without
};

struct MirrorRay {
  glm::vec3 origin_m, direction;  ///< of length 1
  float spread, roughness;        ///< as Surroundings::radiance() takes them: what the ray stands for
  int index;                      ///< its number in its lobe, which chooses its way from the surfaces that it meets
  glm::vec3 radiance{0};          ///< what trace() finds, where it meets the object
  bool meets_object = false;
};

class MirrorRays {
 public:
  /// Keeps references. `skin_m`: back faces closer than that are the surface
  /// that the ray starts from, whose smoothed normals let it dip below its triangles.
  MirrorRays(const Mesh& mesh, const RayScene& scene, const SurfaceTextures& textures, const BrdfTable& brdf, float skin_m);

  void set_frame(const Surroundings& around, const VertexLight& light, const glm::vec3& exposure);

  /// The place above a surface where its rays start.
  glm::vec3 start(const glm::vec3& position_m, const glm::vec3& normal) const { return position_m + 0.05f * skin_m_ * normal; }

  /// Follows the rays. Metal is followed to metal twice more; from there on the surroundings are all that is mirrored.
  void trace(std::span<MirrorRay> rays) const;

  /// Sets only meets_object, by each ray's nearest hit.
  void look(std::span<MirrorRay> rays) const;

 private:
  struct Walk;
  struct Batch;

  void find_hits(Batch& batch, Coherence coherence) const;
  bool meet(Walk& walk, const RayStream& hits, std::size_t at, MirrorRay& ray, int bounce) const;

  const Mesh& mesh_;
  const RayScene& scene_;
  const SurfaceTextures& textures_;
  const BrdfTable& brdf_;
  float skin_m_;
  const Surroundings* around_ = nullptr;
  VertexLight light_;
  glm::vec3 exposure_{1};
};

}  // namespace catchlight::render
