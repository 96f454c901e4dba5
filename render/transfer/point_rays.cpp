#include "render/transfer/point_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/math/sh.hpp"

namespace catchlight::render {

PointRays::PointRays(const RayScene& scene, int rays) : scene_(scene), directions_(rays), weight_(rays) {
  rays_.resize(rays);
  for (auto* lane : {&blocked_x_, &blocked_y_, &blocked_z_, &blocked_weight_}) lane->resize(rays);
}

void PointRays::trace(const glm::vec3& origin_m) {
  std::ranges::fill(rays_.origin_x_m, origin_m.x);
  std::ranges::fill(rays_.origin_y_m, origin_m.y);
  std::ranges::fill(rays_.origin_z_m, origin_m.z);
  std::ranges::fill(rays_.near, 0.0f);
  std::ranges::fill(rays_.far, std::numeric_limits<float>::infinity());
  scene_.closest_hits(rays_, Coherence::coherent);
}

void PointRays::send_over_hemisphere(const glm::vec3& origin_m, const glm::vec3& normal, std::uint32_t seed) {
  directions_.fill_hemisphere(normal, seed, directions());
  std::ranges::fill(weight_, 1.0f / static_cast<float>(weight_.size()));
  trace(origin_m);
}

void PointRays::send_at_ball(const glm::vec3& origin_m, const glm::vec3& middle_m, float radius_m, std::uint32_t seed) {
  const glm::vec3 to_middle_m = middle_m - origin_m;
  const double sin_cone = radius_m / glm::length(to_middle_m);
  if (sin_cone >= 0.7) return send_over_hemisphere(origin_m, glm::vec3(0, 0, 1), seed);
  const double cos_cone = std::sqrt(1 - sin_cone * sin_cone);
  directions_.fill_cone(to_middle_m, cos_cone, seed, directions());
  const auto scale = static_cast<float>(2 * (1 - cos_cone) / static_cast<double>(weight_.size()));
  for (std::size_t k = 0; k < weight_.size(); ++k) weight_[k] = scale * std::max(rays_.direction_z[k], 0.0f);
  trace(origin_m);
}

void PointRays::add_blocked_light(int bands, std::span<float> sums) {
  std::size_t blocked = 0;
  for (std::size_t k = 0; k < weight_.size(); ++k) {  // without a branch: each is overwritten by the next where it is not blocked
    blocked_x_[blocked] = rays_.direction_x[k], blocked_y_[blocked] = rays_.direction_y[k];
    blocked_z_[blocked] = rays_.direction_z[k], blocked_weight_[blocked] = weight_[k];
    blocked += rays_.meets(k);
  }
  const auto first = [blocked](const std::vector<float>& lane) { return std::span(lane).first(blocked); };
  add_sh(first(blocked_x_), first(blocked_y_), first(blocked_z_), first(blocked_weight_), bands, sums);
}

}  // namespace catchlight::render
