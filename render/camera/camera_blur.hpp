// Defocus and motion blur of the virtual layer, as the lens and the shutter blur the light: how much, and where to. A sharp view
// costs nothing.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/projection.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/camera_effects.hpp"
#include "render/frame_view.hpp"
#include "render/mesh/bounds.hpp"

namespace catchlight::render {

/// The motion of what is seen at a pixel while the shutter is open: displacement + change * (pixel - origin), in pixels.
struct MotionField {
  glm::dvec2 origin_px{0.0}, displacement_px{0.0};
  glm::dmat2 change{0.0};

  glm::dvec2 at(const glm::dvec2& pixel) const { return displacement_px + change * (pixel - origin_px); }
};

/// The motion field by least squares over points fixed to the tag, as the camera sees them; 0 where fewer than three are in view.
MotionField fit_motion(const CameraModel& camera, const DistortionLimit& limit, const RigidTransform& camera_from_tag,
                       const TagMotion& motion, std::span<const glm::dvec3> points_tag_m);

/// e^-t I_n(t) for n = 0, 1, ...: the Gaussian of samples, whose variance is exactly t and which applied twice is that of 2 t
/// (Lindeberg 1990, "Scale-space for discrete signals"). Ends where less than `invisible` of it is left; with its mirror it sums
/// to 1.
std::vector<float> discrete_gaussian(double variance, double invisible = 1e-5);

inline constexpr double kMaxDefocus_px2 = 400, kMaxMotion_px = 120;

struct CameraBlurPlan {
  double variance_px2 = 0;
  MotionField object, shadow;
  bool moves = false;

  bool empty() const { return variance_px2 == 0 && !moves; }
  int reach_px(const PixelRect& rect) const;  ///< how far around a pixel of `rect` its light comes from
};

/// `limit`: the distortion limit of the view's camera. `box`: around the object, tag frame; its footprint stands for where
/// shadows fall. Less than half a pixel of motion, which widens no edge by more than a 50th pixel squared, counts as none.
CameraBlurPlan plan_camera_blur(const FrameView& view, const DistortionLimit& limit, const Bounds& box);

}  // namespace catchlight::render
