// The shadow on the receiving plane as a texture fixed to the tag: the ratio of shadowed to unshadowed irradiance (Debevec 1998).
// Made when the light turns; per frame it is only looked up.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/cache/content_cache.hpp"
#include "render/cpu/receiver/plane_lights.hpp"
#include "render/math/float4.hpp"
#include "render/mesh/bounds.hpp"
#include "render/rays/ray_scene.hpp"
#include "render/receiver_light.hpp"
#include "render/split_light.hpp"
#include "render/transfer/transfer.hpp"

namespace catchlight::render {

class ReceiverShadow {
 public:
  /// Keeps references. `transfer` must have a grid of at least 2 x 2 points; `object` is the box around what casts the shadow.
  ReceiverShadow(const Transfer& transfer, const RayScene& rays, const Bounds& object);

  /// Finds the plane's shadow under `light_tag`; more coarsely where that does not stand still. `kept`: for that transfer and
  /// light, standing still.
  void update(const SplitLight& light_tag, bool stands_still, const KeyedCache& kept = {});

  /// The part of the plane where the ratio differs from 1 by more than can be seen.
  const PlaneRect& reach() const { return reach_; }

  /// Begins to bring to the processor what ratio() will need.
  void prefetch(const glm::vec2& place_m) const;

  /// The ratio at a place of the plane (tag x, y); 1 beyond the reach, and where the place is NaN.
  glm::vec3 ratio(const glm::vec2& place_m) const;

 private:
  /// A ratio in steps of 1 / 16384, the fourth unused: half the size of floats, which is half of the time to fetch them.
  using Texel = std::uint16_t __attribute__((vector_size(8)));

  void draw_ratio(const OpenPlaneLight& open, std::span<const glm::vec3> grid_light, const PlaneLights& lights);
  void crop();
  void archive(CacheStream& file);

  const Transfer& transfer_;
  const RayScene& rays_;
  Bounds object_;
  PlaneRect reach_;
  glm::ivec2 size_{0};  ///< texels
  glm::vec2 texels_per_m_{0};
  std::vector<Texel> ratio_;
};

}  // namespace catchlight::render
