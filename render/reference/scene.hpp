// What the reference traces: the product's own data, before anything is precomputed from it.
#pragma once

#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/mesh/mesh.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::render::reference {

/// A frame of the footage as light: what the camera saw without the object.
struct FrameLight {
  Image radiance;  ///< scene-linear, the whole frame, in the probe's units
  CameraModel camera;
  RigidTransform camera_from_tag;
};

/// A scene to be traced, all in the tag frame.
///
/// The receiver is the plane z = 0, opaque and Lambertian. Without the object it has the radiance that the frame shows there, or,
/// where the frame does not show it, what the probe sees from probe_in_tag_m. Its albedo is that radiance by the probe's
/// irradiance on it. Where there is a receiver, the probe lights from above (z > 0) only and everything below comes off the
/// plane.
struct ReferenceScene {
  Mesh mesh;  ///< fronts of triangles reflect; backs block light and reflect nothing. May be empty.
  Probe probe;
  glm::dmat3 tag_from_probe{1.0};
  bool has_receiver = false;
  glm::dvec3 probe_in_tag_m{0.0};  ///< where the probe was captured
  std::optional<FrameLight> frame;
  glm::dvec3 unlit_radiance{1.0};  ///< radiance of a surface whose unlit colour is 1
};

}  // namespace catchlight::render::reference
