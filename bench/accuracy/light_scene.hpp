// What light_accuracy lights: a ball and a box on a plane, the points that are looked at, and the light that reaches them.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "render/mesh/mesh.hpp"
#include "render/rays/ray_scene.hpp"
#include "render/transfer/transfer.hpp"

namespace catchlight::render {

/// A place on the object or the plane, tag frame. Rays start at `origin_m`, a hair above it.
struct SeenPoint {
  glm::vec3 origin_m, normal;
  std::size_t index;  ///< number of the vertex or of the receiver's grid point
};

struct LightScene {
  Mesh mesh;  ///< white
  ReceiverGrid grid;
  std::unique_ptr<RayScene> rays;
  std::vector<SeenPoint> object, ground;  ///< well apart from each other; on the ground only those that the object leaves open
};

LightScene make_light_scene();

/// Radiance from `direction` (tag frame, length 1) times its solid angle, as luminance.
struct Ray {
  glm::vec3 direction;
  double flux;
};

/// The whole probe as rays, each of a small share of its light: dim texels together, bright ones in pieces, so that a sun has its
/// width. Dim texels that share a ray are neighbours.
std::vector<Ray> rays_of(const Probe& probe, const glm::dmat3& tag_from_probe);

/// Irradiance / pi of all the rays that reach the point.
double brute_force(const LightScene& scene, const SeenPoint& point, const std::vector<Ray>& rays);

/// The same with nothing in the way.
double unshadowed(const glm::vec3& normal, const std::vector<Ray>& rays);

}  // namespace catchlight::render
