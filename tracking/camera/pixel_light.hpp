// The light of the pixels that somebody looks at, and of no others.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/code_view.hpp"
#include "catchlight/frame_image.hpp"
#include "catchlight/light_table.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::tracking {

/// A frame's light: linear RGB of Rec. 709's primaries, 1 = sensor white.
struct PixelLight {
  CodeView codes;
  LightTable light_of_code;
  glm::mat3 rec709_from_frame{1.0f};
  glm::vec3 clipping_linear;  ///< light of the clipping level: at or above, the true value is unknown

  /// The pixel must be in the picture.
  glm::vec3 at(int x, int y) const {
    glm::vec3 code = codes.rgb(x, y);
    if (!codes.is_real) code = glm::clamp(code, 0.0f, 1.0f);
    return rec709_from_frame * glm::vec3(light_of_code(code.r, 0), light_of_code(code.g, 1), light_of_code(code.b, 2));
  }
};

PixelLight pixel_light(const FrameImage& frame);

/// A square on the plane z = 0, its sides along x and y.
struct PlaneSquare {
  glm::dvec2 low_m;
  double side_m = 0;
};

struct SquareLight {
  glm::dvec3 mean{0.0};
  glm::ivec3 clipped{0};  ///< samples at the clipping level
  int samples = 0;
};

/// Mean of the nearest pixels to `across` by `across` points that lie evenly in the square; empty where it is not wholly in the
/// picture.
std::optional<SquareLight> square_light(const PixelLight& light, const CameraModel& camera,
                                        const RigidTransform& camera_from_plane, const PlaneSquare& square, int across);

}  // namespace catchlight::tracking
