// What the object's surfaces mirror, by rays over the lobe around the mirror direction. Neighbours on a surface that bends little
// share a lobe's rays, and rays are traced only near where one of them meets the object: elsewhere the surroundings are looked
// up.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/cpu/mirror/lobe_directions.hpp"
#include "render/cpu/mirror/mirror_rays.hpp"
#include "render/cpu/mirror/surroundings.hpp"
#include "render/cpu/surface/visible_surface.hpp"
#include "render/surface_material.hpp"

namespace catchlight::render {

class MirroredLight {
 public:
  /// Keeps references. `lobe_rays`: over the lobe of a rough surface; 0: the probe alone is mirrored.
  MirroredLight(const SurfaceMaterials& materials, const MirrorRays& rays, int lobe_rays);

  /// Mean radiance over each point's lobe, before what the surface keeps of it; 0 for points that mirror nothing.
  /// `has_highlights`: lights are split off, which rough surfaces show as highlights: their lobes leave those out.
  std::span<const glm::vec3> find(const VisibleSurface& surface, const Surroundings& around, bool has_highlights);

 private:
  struct Sum {
    glm::vec3 light{0};
    float weight = 0;
  };
  struct Frame {
    const VisibleSurface& surface;
    const Surroundings& around;
    bool has_highlights;
  };
  /// Rays of some points' lobes.
  struct PointRays {
    struct Of {
      std::size_t point;
      float weight;  ///< in its point's sum
    };
    std::vector<MirrorRay> rays;
    std::vector<Of> of;
  };

  bool mirrors(const Frame& frame, const SurfacePoint& point) const;
  bool is_rough(const Frame& frame, const SurfacePoint& point) const;
  int sharers_of(const Frame& frame, std::size_t index) const;
  const LobePoints& points_of(const Frame& frame, std::size_t index) const;
  const LobePoints& look_point_of(const Frame& frame, std::size_t index) const;
  Lobe lobe_of(const Frame& frame, std::size_t index) const;
  float ray_roughness(const Frame& frame, const SurfacePoint& point) const;
  void find_mirror_directions(const Frame& frame);
  void find_footprints(const Frame& frame, std::size_t index);
  void look_for_object(const Frame& frame);
  void add_seen(const Frame& frame, const PointRays& seen);
  void trace(const Frame& frame, std::size_t first, std::size_t last);
  Sum sum_around(const Frame& frame, std::size_t index, int sharers) const;
  glm::vec3 shared(const Frame& frame, std::size_t index) const;

  const SurfaceMaterials& materials_;
  const MirrorRays& rays_;
  int lobe_rays_;
  std::vector<LobePoints> rough_points_;  ///< of 1 sharer, of each of 2, of each of 4 and of each of 8
  std::vector<LobePoints> look_points_;   ///< one each, of neighbours in turn
  LobePoints polished_points_, single_point_;
  std::vector<glm::vec3> mirror_, footprint_x_, footprint_y_;  ///< of each point
  std::vector<char> hit_, near_hit_;  ///< a pixel each: whether its first ray, or a neighbour's, meets the object
  std::vector<Sum> sums_;
  std::vector<glm::vec3> result_;
};

}  // namespace catchlight::render
