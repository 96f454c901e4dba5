// The rays of the bake's points, and what they meet.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/math/hemisphere_rays.hpp"
#include "render/rays/ray_scene.hpp"

namespace catchlight::render {

/// Rays from one point after the other. One object serves one thread.
class PointRays {
 public:
  PointRays(const RayScene& scene, int rays);

  /// Sends the rays over the hemisphere of the normal, with density cos / pi.
  void send_over_hemisphere(const glm::vec3& origin_m, const glm::vec3& normal, std::uint32_t seed);

  /// Sends them so that the sum of weight * f is (1 / pi) integral of max(z, 0) f dw for any f that is 0 where the ball is not.
  /// From afar the ball is small in the sky: there the rays go into the cone around it, uniformly.
  void send_at_ball(const glm::vec3& origin_m, const glm::vec3& middle_m, float radius_m, std::uint32_t seed);

  /// What the rays met.
  const RayStream& rays() const { return rays_; }
  /// The weights of the rays: their sum over a whole hemisphere is 1.
  std::span<const float> weights() const { return weight_; }

  /// Whether a ray is one of the first that so many would be: those alone sample what they all do.
  bool is_among_first(std::size_t k, int count) const { return directions_.numbers()[k] < static_cast<std::uint32_t>(count); }

  /// Adds weight * y_i(direction) of the rays that met something to sums[i], for all bands.
  void add_blocked_light(int bands, std::span<float> sums);

 private:
  void trace(const glm::vec3& origin_m);
  HemisphereRays::Directions directions() { return {rays_.direction_x, rays_.direction_y, rays_.direction_z}; }

  const RayScene& scene_;
  HemisphereRays directions_;
  RayStream rays_;
  std::vector<float> weight_;
  std::vector<float> blocked_x_, blocked_y_, blocked_z_, blocked_weight_;
};

}  // namespace catchlight::render
