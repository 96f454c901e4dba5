#include "render/frame_plan.hpp"

#include "render/camera/clip_from_camera.hpp"

namespace catchlight::render {
namespace {

bool sees_front_of_receiver(const FrameView& view) {
  return inverse(view.camera_from_tag).translation_m.z > 0;
}

double passed_at_tag(const FrameView& view, const DistortionLimit& limit) {
  const auto tag_px = project_px(view.camera, view.camera_from_tag * view.tag_in_scene_m, &limit);
  return tag_px ? vignetting_at(view.camera, *tag_px) : 0;
}

/// The pixels that object or shadow may touch before they are blurred.
PixelRect sharp_rect(const FrameView& view, const SceneNeeds& scene, const FramePlan& plan) {
  PixelRect rect;
  if (!scene.object.empty()) rect = visible_rect(view.camera, plan.distortion_limit, view.camera_from_tag, scene.object, kNear_m);
  if (!plan.draws_receiver) return rect;
  const Bounds reach{glm::vec3(scene.shadow_reach->min_m, 0), glm::vec3(scene.shadow_reach->max_m, 0)};
  return unite(rect, visible_rect(view.camera, plan.distortion_limit, view.camera_from_tag, reach, kNear_m));
}

}  // namespace

FramePlan plan_frame(const FrameView& view, const SceneNeeds& scene, bool want_layers) {
  FramePlan plan;
  plan.frame = {0, 0, view.camera.width_px, view.camera.height_px};
  plan.makes_layers = want_layers;
  plan.is_toned = scene.recodes_frames && !want_layers;
  if (!view.has_pose) return plan;
  plan.distortion_limit = distortion_limit(view.camera);
  plan.passed_at_tag = passed_at_tag(view, plan.distortion_limit);
  plan.draws_receiver = scene.shadow_reach.has_value() && sees_front_of_receiver(view);
  const PixelRect sharp = sharp_rect(view, scene, plan);
  if (sharp.empty()) return plan;
  plan.blur = plan_camera_blur(view, plan.distortion_limit, scene.object);
  plan.virtual_rect = intersect(grown(sharp, plan.blur.reach_px(sharp)), plan.frame);
  plan.mirrors_receiver = plan.draws_receiver && scene.mirrors;
  plan.seeks_glare = scene.has_glare;
  return plan;
}

}  // namespace catchlight::render
