#include "render/receiver_light.hpp"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <vector>

#include "catchlight/color.hpp"

namespace catchlight::render {
namespace {

constexpr float kFarthestShadow = 16;  ///< distance in sizes of the object
constexpr float kTexelsAcrossObject = 192;
constexpr int kMinTexels = 16, kMaxTexels = 1024;

glm::dvec3 dot(std::span<const float> transfer, const ShRgb& light) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < light.size(); ++i) sum += glm::dvec3(light[i]) * static_cast<double>(transfer[i]);
  return sum;
}

double light_on_plane(const LightSample& sample) {
  return glm::dot(kLuminanceWeights, sample.irradiance) * std::max(sample.direction.z, 0.0) / glm::pi<double>();
}

/// The samples less the weakest on the plane, whose shadows are not seen.
std::vector<LightSample> visible_samples(std::span<const LightSample> samples, const OpenPlaneLight& open) {
  std::vector<LightSample> result(samples.begin(), samples.end());
  std::ranges::stable_sort(result, {}, light_on_plane);
  double left_out = 0;
  const double most = kInvisibleShadow * glm::dot(kLuminanceWeights, open.rest + open.lights);
  const auto first_seen =
      std::ranges::find_if(result, [&](const LightSample& sample) { return (left_out += light_on_plane(sample)) > most; });
  result.erase(result.begin(), first_seen);
  return result;
}

}  // namespace

OpenPlaneLight open_plane_light(std::span<const float> unshadowed, const SplitLight& light_tag) {
  OpenPlaneLight result;
  for (const LightSample& sample : light_tag.samples)
    result.lights += sample.irradiance * (std::max(sample.direction.z, 0.0) / glm::pi<double>());
  result.rest = glm::max(dot(unshadowed, light_tag.whole) - dot(unshadowed, light_tag.split_off), 0.0);
  return result;
}

PlaneRect shadow_reach(std::span<const LightSample> samples_tag, const OpenPlaneLight& open, const Bounds& box) {
  constexpr float kNothing = std::numeric_limits<float>::max();
  const PlaneRect nothing{glm::vec2(kNothing), glm::vec2(-kNothing)};
  const float farthest_m = kFarthestShadow * box.diagonal_m();
  PlaneRect reach = nothing;
  for (const LightSample& sample : visible_samples(samples_tag, open)) {
    const glm::vec3 to_light(sample.direction);
    if (!(to_light.z > 0) || !(box.max_m.z > 0)) continue;
    for (const float z : {std::max(box.min_m.z, 0.0f), box.max_m.z}) {
      const glm::vec2 away = -z / std::max(to_light.z, 1e-6f) * glm::vec2(to_light);
      const glm::vec2 shift = away * std::min(1.0f, farthest_m / std::max(glm::length(away), 1e-12f));
      reach = unite(reach, {glm::vec2(box.min_m) + shift, glm::vec2(box.max_m) + shift});
    }
  }
  return reach;
}

ReceiverTexels receiver_texels(const PlaneRect& reach, const Bounds& box, int coarser) {
  const float texel_m = static_cast<float>(coarser) * box.diagonal_m() / kTexelsAcrossObject;
  const glm::ivec2 size = glm::clamp(glm::ivec2((reach.max_m - reach.min_m) / texel_m) + 8, kMinTexels, kMaxTexels / coarser);
  const glm::vec2 margin_m = 4.0f * (reach.max_m - reach.min_m) / glm::vec2(size - 8);
  return {{reach.min_m - margin_m, reach.max_m + margin_m}, size};
}

}  // namespace catchlight::render
