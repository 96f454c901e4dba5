// The light on the receiving plane, as every renderer needs it: what arrives where nothing shadows it, and where shadows may
// fall.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <span>

#include "render/mesh/bounds.hpp"
#include "render/split_light.hpp"
#include "render/transfer/plane_rect.hpp"

namespace catchlight::render {

/// More than this is no shadow's bounce but a defect of the transfer.
inline constexpr float kMaxShadowRatio = 4;

/// Whether a shadow's ratio is so near to 1 that it moves no code by a quarter.
inline bool is_no_shadow(const glm::vec3& ratio) {
  constexpr float kInvisible = 5e-4f;
  return std::abs(ratio.x - 1) < kInvisible && std::abs(ratio.y - 1) < kInvisible && std::abs(ratio.z - 1) < kInvisible;
}

/// Irradiance / pi of the plane where the object shadows nothing.
struct OpenPlaneLight {
  glm::dvec3 rest{0.0};    ///< light that is not split off
  glm::dvec3 lights{0.0};  ///< the lights that are
};

/// `unshadowed`: Transfer::receiver_unshadowed.
OpenPlaneLight open_plane_light(std::span<const float> unshadowed, const SplitLight& light_tag);

/// The part of the plane onto which samples that shine from above it may cast the shadow of what lies in the box (tag frame), no
/// farther away than 16 times its size. Empty (min beyond max) without any.
PlaneRect shadow_reach(std::span<const LightSample> samples_tag, const Bounds& box);

/// Texels that hold the lights' irradiance on the plane.
struct ReceiverTexels {
  PlaneRect rect;  ///< their outer edges
  glm::ivec2 size{0};
};

/// The texels for a reach that is not empty: 192 across the object, at most 1024 along a side, and a few more around the reach,
/// over which the shadow fades where it was cut off.
ReceiverTexels receiver_texels(const PlaneRect& reach, const Bounds& box);

}  // namespace catchlight::render
