// The reference that the product is measured against where no ground truth exists: a path tracer that shares the product's data
// (meshes, probes, cameras) and its ray caster, and none of its lighting. Slow on purpose: nothing is precomputed or filtered.
#pragma once

#include <span>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/progress.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/reference/light_paths.hpp"

namespace catchlight::render::reference {

struct TraceOptions {
  int samples = 256;  ///< paths a pixel or point; a power of two covers best
  int bounces = 6;    ///< reflections after the first
  std::uint32_t seed = 1;
  int threads = 0;  ///< 0: all cores. The result does not depend on it.
};

/// composite radiance = frame's radiance * kept + object; box filter over each pixel.
struct ReferencePicture {
  Image object;  ///< radiance times coverage
  Image kept;    ///< factor on what the frame shows: exactly 1 where the object changes nothing
};

class PathTracer {
 public:
  /// Throws Error for options out of range.
  PathTracer(ReferenceScene scene, const TraceOptions& options);
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  /// What the camera sees; without a receiver only the object.
  ReferencePicture render(const CameraModel& camera, const RigidTransform& camera_from_tag,
                          const ProgressHandler& progress) const;

  /// Radiance that leaves Lambertian points, e.g. vertices of the mesh: times pi with albedo 1 their irradiance. Rays follow the
  /// normal's hemisphere.
  std::vector<glm::dvec3> exit_radiance(std::span<const MattePoint> points, const ProgressHandler& progress = {}) const;

  /// Light on points (x, y) of the receiver relative to that without the object.
  std::vector<glm::dvec3> receiver_ratio(std::span<const glm::dvec2> points_m, const ProgressHandler& progress = {}) const;

 private:
  ReferenceScene scene_;
  TraceOptions options_;
  LightPaths paths_;
};

/// The mesh's vertices as Lambertian points with their diffuse albedo (black where metal); a vertex that several materials share
/// has the first one's.
std::vector<MattePoint> matte_vertices(const Mesh& mesh);

}  // namespace catchlight::render::reference
