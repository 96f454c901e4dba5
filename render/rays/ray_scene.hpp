// Rays against a mesh (Embree). Safe to ask from many threads.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "render/mesh/mesh.hpp"
#include "render/rays/ray_stream.hpp"

namespace catchlight::render {

struct RayHit {
  std::uint32_t triangle = 0;
  float u = 0, v = 0;        ///< barycentric weights of corners 1 and 2
  bool front_facing = true;  ///< seen from the side where the corners wind counter-clockwise
};

/// Whether rays that stand side by side in a stream start near each other and go much the same way. Embree then takes them
/// through its hierarchy as one, three times as fast; where it is not so, that is slower. The answers are the same.
enum class Coherence { coherent, incoherent };

class RayScene {
 public:
  /// Keeps a reference to `mesh`. Throws Error where memory runs out.
  explicit RayScene(const Mesh& mesh);
  ~RayScene();

  /// Whether the ray meets anything at all, on either side of its faces.
  bool occluded(const glm::vec3& origin_m, const glm::vec3& direction) const;
  std::optional<RayHit> closest_hit(const glm::vec3& origin_m, const glm::vec3& direction) const;

  /// Finds what each ray meets first between `near` and `far`.
  void closest_hits(RayStream& rays, Coherence coherence) const;
  /// Sets `far` of each ray that meets anything between `near` and `far` to minus infinity, and changes nothing else.
  void find_occluded(RayStream& rays, Coherence coherence) const;

 private:
  struct Handles;
  const Mesh& mesh_;
  std::unique_ptr<Handles> handles_;
};

}  // namespace catchlight::render
