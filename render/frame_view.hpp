// The camera's part of one frame.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tone_curve.hpp"
#include "render/camera_effects.hpp"

namespace catchlight::render {

/// The camera's part of one frame: exposed linear value = exposure * radiance + black, at the tag; elsewhere exposure is more or
/// less by as much as the camera's vignetting is.
struct FrameView {
  CameraModel camera;
  RigidTransform camera_from_tag;
  glm::dvec3 tag_in_scene_m{0.0};  ///< the tag's middle: where the exposure is known
  glm::vec3 exposure{1.0f};
  glm::vec3 black{0.0f};
  glm::vec3 receiver_light{
      0.0f};  ///< unshadowed, exposed linear: what clipped pixels of the plate are taken to hide; 0: not known
  PlateColor color;
  glm::dmat3 tag_from_light{1.0};  ///< turns the light against the tag
  bool light_turns = false;        ///< with every frame (probe fixed to the camera): little is to be prepared for each turn
  bool has_pose = true;            ///< false: nothing virtual is drawn; the tone curve, where there is one, is
  std::optional<ToneCurve> tone;   ///< what the exposure has adapted to; none: what the frame itself calls for
  CameraEffects effects;           ///< what else the camera does to the virtual layer
};

}  // namespace catchlight::render
