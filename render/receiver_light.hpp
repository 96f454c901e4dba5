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

/// The change of the light up to which a shadow is not drawn: it moves no code of 8 bits by a quarter.
inline constexpr float kInvisibleShadow = 1e-3f;

/// Whether the ratio is that of no shadow to the eye.
inline bool is_no_shadow(const glm::vec3& ratio) {
  return std::abs(ratio.x - 1) < kInvisibleShadow && std::abs(ratio.y - 1) < kInvisibleShadow &&
         std::abs(ratio.z - 1) < kInvisibleShadow;
}

/// Irradiance / pi of the plane where the object shadows nothing.
struct OpenPlaneLight {
  glm::dvec3 rest{0.0};    ///< light that is not split off
  glm::dvec3 lights{0.0};  ///< the lights that are
};

/// `unshadowed`: Transfer::receiver_unshadowed.
OpenPlaneLight open_plane_light(std::span<const float> unshadowed, const SplitLight& light_tag);

/// The part of the plane onto which samples that shine from above it may cast the shadow of what lies in the box (tag frame), no
/// farther away than 16 times its size. Samples that graze the plane throw long shadows which nobody sees: those that together
/// give less than kInvisibleShadow of the open plane's light count for nothing. Empty (min beyond max) without any.
PlaneRect shadow_reach(std::span<const LightSample> samples_tag, const OpenPlaneLight& open, const Bounds& box);

/// Texels that hold the lights' irradiance on the plane.
struct ReceiverTexels {
  PlaneRect rect;  ///< their outer edges
  glm::ivec2 size{0};
};

/// The texels for a reach that is not empty: 192 across the object, at most 1024 along a side, and a few more around the reach,
/// over which the shadow fades where it was cut off. `coarser`: so many times fewer each way.
ReceiverTexels receiver_texels(const PlaneRect& reach, const Bounds& box, int coarser = 1);

}  // namespace catchlight::render
