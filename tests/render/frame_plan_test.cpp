// What a frame is found to need, without any GL.
#include "render/frame_plan.hpp"

#include <gtest/gtest.h>

namespace catchlight::render::test {
namespace {

const PixelRect kNothing{};

/// Straight from above, a millimetre of the tag's plane to 0.4 px.
FrameView view_from_above() {
  FrameView view;
  view.camera = {.width_px = 160, .height_px = 120, .fx_px = 200, .fy_px = 200, .cx_px = 79.5, .cy_px = 59.5, .distortion = {}};
  view.camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  view.camera_from_tag.translation_m = {0, 0, 0.5};
  return view;
}

/// The same from below: the tag's printed face looks away.
FrameView view_from_below() {
  FrameView view = view_from_above();
  view.camera_from_tag.rotation = glm::dmat3(1);
  return view;
}

/// A box of 20 mm on the receiver, whose shadow may fall 50 mm around the tag's middle.
SceneNeeds mirroring_box() {
  SceneNeeds scene;
  scene.object = {{-0.01f, -0.01f, 0}, {0.01f, 0.01f, 0.02f}};
  scene.shadow_reach = PlaneRect{{-0.05f, -0.05f}, {0.05f, 0.05f}};
  scene.mirrors = true;
  scene.has_glare = true;
  return scene;
}

bool holds(const PixelRect& outer, const PixelRect& inner) {
  return unite(outer, inner) == outer;
}

TEST(FramePlan, HoldsObjectAndShadow) {
  const FramePlan plan = plan_frame(view_from_above(), mirroring_box(), false);
  EXPECT_TRUE(plan.draws_receiver && plan.mirrors_receiver && plan.seeks_glare);
  EXPECT_FALSE(plan.makes_layers || plan.is_toned || plan.empty());
  EXPECT_TRUE(plan.blur.empty());
  // 50 mm are 20 px; the border is a few pixels.
  EXPECT_TRUE(holds(plan.virtual_rect, {60, 40, 40, 40}));
  EXPECT_TRUE(holds({50, 30, 60, 60}, plan.virtual_rect)) << plan.virtual_rect.width << " x " << plan.virtual_rect.height;
  EXPECT_EQ(plan.output_rect(plan.virtual_rect, kNothing), plan.virtual_rect);
  EXPECT_TRUE(holds(plan.output_rect(plan.virtual_rect, {0, 0, 10, 10}), {0, 0, 10, 10})) << "glare reaches further";
}

TEST(FramePlan, FromBehindTheReceiverIsNeitherDrawnNorMirrored) {
  const FramePlan plan = plan_frame(view_from_below(), mirroring_box(), false);
  EXPECT_FALSE(plan.draws_receiver || plan.mirrors_receiver);
  EXPECT_TRUE(plan.draws_virtual()) << "the object is seen still";
  EXPECT_TRUE(holds({65, 45, 30, 30}, plan.virtual_rect)) << "and no shadow around it";
}

TEST(FramePlan, MirrorsAloneOrAReceiverAloneNeedNoPlateBefore) {
  SceneNeeds scene = mirroring_box();
  scene.mirrors = false;
  EXPECT_FALSE(plan_frame(view_from_above(), scene, false).mirrors_receiver);
  scene.mirrors = true;
  scene.shadow_reach.reset();
  EXPECT_FALSE(plan_frame(view_from_above(), scene, false).mirrors_receiver);
}

TEST(FramePlan, ALostFrameNeedsNothing) {
  FrameView view = view_from_above();
  view.has_pose = false;
  const FramePlan plan = plan_frame(view, mirroring_box(), false);
  EXPECT_TRUE(plan.empty());
  EXPECT_FALSE(plan.seeks_glare || plan.mirrors_receiver || plan.draws_receiver);
}

TEST(FramePlan, AToneCurveNeedsTheWholeFrameAlsoWithoutAPose) {
  SceneNeeds scene = mirroring_box();
  scene.recodes_frames = true;
  FrameView view = view_from_above();
  EXPECT_EQ(plan_frame(view, scene, false).output_rect(kNothing, kNothing), (PixelRect{0, 0, 160, 120}));
  view.has_pose = false;
  const FramePlan lost = plan_frame(view, scene, false);
  EXPECT_TRUE(lost.is_toned && !lost.empty() && !lost.draws_virtual());
  EXPECT_EQ(lost.output_rect(kNothing, kNothing), lost.frame);
}

TEST(FramePlan, LayersAreWholeFramesOfLightThatNoToneCurveChanges) {
  SceneNeeds scene = mirroring_box();
  scene.recodes_frames = true;
  const FramePlan plan = plan_frame(view_from_above(), scene, true);
  EXPECT_TRUE(plan.makes_layers);
  EXPECT_FALSE(plan.is_toned);
  EXPECT_EQ(plan.output_rect(plan.virtual_rect, kNothing), plan.frame);
}

TEST(FramePlan, BlurWidensWhatIsDrawnWithinTheFrame) {
  FrameView view = view_from_above();
  const PixelRect sharp = plan_frame(view, mirroring_box(), false).virtual_rect;
  view.effects.defocus_px2 = 4;
  const FramePlan plan = plan_frame(view, mirroring_box(), false);
  EXPECT_FALSE(plan.blur.empty());
  const int reach = plan.blur.reach_px(sharp);
  EXPECT_EQ(plan.virtual_rect, (PixelRect{sharp.x - reach, sharp.y - reach, sharp.width + 2 * reach, sharp.height + 2 * reach}));
  view.effects.defocus_px2 = kMaxDefocus_px2;
  EXPECT_TRUE(holds(plan.frame, plan_frame(view, mirroring_box(), false).virtual_rect));
}

TEST(FramePlan, AnEmptySceneDrawsNothingAndMirrorsNothing) {
  EXPECT_TRUE(plan_frame(view_from_above(), SceneNeeds{}, false).empty());
  SceneNeeds shadow_alone;
  shadow_alone.shadow_reach = PlaneRect{{-0.05f, -0.05f}, {0.05f, 0.05f}};
  EXPECT_TRUE(plan_frame(view_from_above(), shadow_alone, false).draws_virtual());
}

}  // namespace
}  // namespace catchlight::render::test
