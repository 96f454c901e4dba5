// Light transport: paths from a point towards the light, one random sample of an integral each.
//
// At every surface the probe's lights are sampled (next-event estimation) and the path goes on by the surface's own reflection;
// both ways of meeting the probe are weighted by the balance heuristic (Veach & Guibas 1995), lobe by lobe.
//
// There are no caustics: after a Lambertian reflection, glossy surfaces are black. So a mirror darkens the table around it and
// never lights it, as in the ground truth.
#pragma once

#include <memory>

#include "render/rays/ray_scene.hpp"
#include "render/reference/brdf.hpp"
#include "render/reference/camera_rays.hpp"
#include "render/reference/point_stream.hpp"
#include "render/reference/probe_sampler.hpp"
#include "render/reference/scene.hpp"

namespace catchlight::render::reference {

/// A Lambertian point of a surface that need not be part of the mesh.
struct MattePoint {
  glm::dvec3 position_m, normal, albedo;
};

/// What one ray of the camera sees.
struct Seen {
  glm::dvec3 object{0};  ///< the object's radiance, where it is in the way
  glm::dvec3 kept{0};    ///< factor on what the frame shows: 0 on the object, the shadow on the receiver, 1 elsewhere
};

class LightPaths {
 public:
  /// Keeps a reference to the scene. `bounces`: reflections after the first.
  LightPaths(const ReferenceScene& scene, int bounces);

  Seen look(const glm::dvec3& origin_m, const glm::dvec3& direction, PointStream points) const;

  /// Radiance that leaves the point.
  glm::dvec3 exit_radiance(const MattePoint& point, PointStream points) const;

  /// Light on the receiver at (x, y), relative to that without the object.
  glm::dvec3 receiver_ratio(const glm::dvec2& point_m, PointStream points) const;

 private:
  struct Path;
  struct Surface;
  enum class Met { sky, object, back_of_object, receiver, below_receiver };
  struct Meeting {
    Met what = Met::sky;
    glm::dvec3 position_m{0};
    RayHit hit;
  };

  Meeting meet(const glm::dvec3& origin_m, const glm::dvec3& direction) const;
  bool blocked(const glm::dvec3& origin_m, const glm::dvec3& direction) const;
  Surface surface_at(const Meeting& meeting, const glm::dvec3& direction) const;
  glm::dvec3 receiver_radiance(const glm::dvec3& point_m) const;

  void follow(Path& path, PointStream& points) const;
  bool scatter(Path& path, const Surface& surface, PointStream& points) const;
  void add_sampled_light(Path& path, const Surface& surface, double glossy_share, PointStream& points) const;
  bool scatter_on_receiver(Path& path, const glm::dvec3& point_m, const glm::dvec3& albedo_over_pi, PointStream& points) const;

  const ReferenceScene& scene_;
  int bounces_;
  double lift_m_;  ///< height above a surface at which its rays start
  ProbeSampler light_;
  glm::dvec3 one_over_irradiance_{0};  ///< 1 / irradiance on the receiver without the object; 0 in channels without light
  std::unique_ptr<RayScene> rays_;     ///< none where the mesh is empty
  std::optional<CameraRays> frame_rays_;
};

}  // namespace catchlight::render::reference
