// What a frame will need, decided before any of it is drawn.
#pragma once

#include <optional>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/projection.hpp"
#include "render/camera/camera_blur.hpp"
#include "render/frame_view.hpp"
#include "render/mesh/bounds.hpp"
#include "render/transfer/plane_rect.hpp"

namespace catchlight::render {

/// Nearest distance from the camera at which anything is drawn.
inline constexpr double kNear_m = 1e-3;

/// What a scene may ask of any frame, in the tag frame.
struct SceneNeeds {
  Bounds object;                          ///< the box around the object; empty: there is none
  std::optional<PlaneRect> shadow_reach;  ///< where the receiver may be in shadow under the present light; none: no receiver
  bool mirrors = false;                   ///< some surface mirrors what is around it, not the probe alone
  bool has_glare = false;                 ///< highlights of the virtual layer spill
  bool recodes_frames = false;            ///< a tone curve or the classic look changes every pixel
};

struct FramePlan {
  PixelRect frame;         ///< all pixels of the frame
  PixelRect virtual_rect;  ///< pixels that the object, its shadow and their blur may touch; empty: nothing virtual is drawn
  CameraBlurPlan blur;
  DistortionLimit distortion_limit{};  ///< limit of the view's camera
  double passed_at_tag = 0;            ///< share of light that vignetting leaves at the tag; 0: the tag is not in front
  bool draws_receiver = false;         ///< the camera is in front of the receiver
  bool mirrors_receiver = false;       ///< mirrors show the receiver as the frame does, so that all of the plate comes first
  bool seeks_glare = false;            ///< the virtual layer may have highlights: known once it is drawn
  bool makes_layers = false;
  bool is_toned = false;  ///< the composite is linear light, which a tone curve makes codes of

  bool draws_virtual() const { return !virtual_rect.empty(); }
  bool empty() const { return !draws_virtual() && !makes_layers && !is_toned; }
  /// The pixels that are composited where the virtual layer was drawn in those of `drawn`, and glare reaches those of
  /// `glare_rect`.
  PixelRect output_rect(const PixelRect& drawn, const PixelRect& glare_rect) const {
    return makes_layers || is_toned ? frame : unite(drawn, glare_rect);
  }
};

/// The plan of a frame. Layers are the scene's light: with them there is no tone curve.
FramePlan plan_frame(const FrameView& view, const SceneNeeds& scene, bool want_layers);

}  // namespace catchlight::render
