// The fit of the whole pattern: how exact it is, and what it says about light, blur and its own worth.
#include "tracking/refinement/direct_refinement.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/pose/pose_covariance.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

/// A view of 240x200 px through a long lens; a tag of `side_px` in its middle.
CameraModel small_camera() {
  return {240, 200, 1000, 1000, 119.5, 99.5, {}};
}

SyntheticScene scene_of(double side_px, const glm::dvec3& turn_deg, double noise_codes = 0, unsigned seed = 1) {
  SyntheticScene scene;
  scene.camera = small_camera();
  scene.tags.resize(1);
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {118.3, 101.7}, 1000 * 0.08 / side_px, turn_deg);
  scene.blur_px = 0.7;
  scene.paper_margin_cells = 2;
  scene.noise_codes = noise_codes;
  scene.seed = seed;
  return scene;
}

/// Two thirds of a pixel and two degrees off.
RigidTransform disturbed(const SyntheticScene& scene) {
  RigidTransform pose = scene.tags[0].camera_from_tag;
  pose.translation_m += glm::dvec3(0.5, -0.45, 0) * pose.translation_m.z / scene.camera.fx_px;
  const double turn = glm::radians(2.0);
  pose.rotation =
      pose.rotation * glm::dmat3{{1, 0, 0}, {0, std::cos(turn), std::sin(turn)}, {0, -std::sin(turn), std::cos(turn)}};
  return pose;
}

std::optional<DirectFit> fit(const SyntheticScene& scene, const SyntheticFrame& frame) {
  return DirectRefiner(scene.camera, scene.tags[0].target).refine(frame.luma(), {disturbed(scene)});
}

std::array<glm::dvec2, 4> corners(const SyntheticScene& scene, const RigidTransform& camera_from_tag) {
  SyntheticTag tag = scene.tags[0];
  tag.camera_from_tag = camera_from_tag;
  return true_corners_px(scene.camera, tag);
}

double corner_error_px(const SyntheticScene& scene, const DirectFit& fit) {
  return rms_distance(corners(scene, fit.camera_from_tag), corners(scene, scene.tags[0].camera_from_tag));
}

class OfSize : public ::testing::TestWithParam<double> {};

/// What the literature's best edge refits reach is 0.014 to 0.027 px (per axis).
TEST_P(OfSize, CornersAreWithinTwelveThousandthsOfAPixelUnderNoise) {
  double squares = 0, bias_px = 0;
  constexpr int kFrames = 24;
  for (int i = 0; i < kFrames; ++i) {
    const double phase = 2 * M_PI * i / kFrames;
    const SyntheticScene scene =
        scene_of(GetParam(), {30 * std::cos(phase), 30 * std::sin(phase), 37.0 * i}, 3, static_cast<unsigned>(i + 1));
    const auto found = fit(scene, render(scene));
    ASSERT_TRUE(found) << i;
    squares += std::pow(corner_error_px(scene, *found), 2) / kFrames;
    bias_px += outward_bias_px(corners(scene, found->camera_from_tag), corners(scene, scene.tags[0].camera_from_tag)) / kFrames;
  }
  const double per_axis_px = std::sqrt(squares / 2);
  std::cout << GetParam() << " px: " << per_axis_px << " px per axis, outward bias " << bias_px << " px\n";
  EXPECT_LT(per_axis_px, 0.012);
  EXPECT_NEAR(bias_px, 0, 0.005);
}

INSTANTIATE_TEST_SUITE_P(DirectRefinement, OfSize, ::testing::Values(40, 80, 160));

class FitsFamily : public ::testing::TestWithParam<std::string> {};

TEST_P(FitsFamily, ToAFiftiethOfAPixel) {
  SyntheticScene scene = scene_of(90, {30, -15, 25}, 2);
  scene.tags[0].target = {{GetParam(), 3, 0.08}, {}};
  const auto found = fit(scene, render(scene));
  ASSERT_TRUE(found);
  EXPECT_TRUE(is_convincing(*found));
  EXPECT_LT(corner_error_px(scene, *found), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Library, FitsFamily, ::testing::ValuesIn(tag_families()),
                         [](const auto& family) { return family.param; });

TEST(DirectRefinement, WithoutNoiseWhatIsLeftIsTheRoundingOfCodes) {
  for (const glm::dvec3& turn_deg :
       {glm::dvec3(35, 10, 20), glm::dvec3(-50, 25, -100), glm::dvec3(0, 0, 0), glm::dvec3(60, 0, 45)}) {
    const SyntheticScene scene = scene_of(100, turn_deg);
    const auto found = fit(scene, render(scene));
    ASSERT_TRUE(found);
    EXPECT_LT(corner_error_px(scene, *found), 0.01);
    EXPECT_LT(found->noise_codes, 0.8);
    EXPECT_GT(found->explained, 0.999);
  }
}

TEST(DirectRefinement, ThroughADistortingLensItIsAsExact) {
  SyntheticScene scene;
  scene.camera = distorted_camera();
  scene.tags.resize(1);
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {150, 120}, 0.35, {30, -25, 60});
  const auto found = fit(scene, render(scene));
  ASSERT_TRUE(found);
  EXPECT_LT(corner_error_px(scene, *found), 0.01);
}

/// The error's square over the covariance is 1 per degree of freedom where the covariance is honest. It counts each pixel for
/// half of one, as neighbours in real footage go together; rendered noise is independent, so 0.5 is what it should come to.
TEST(DirectRefinement, TheCovarianceTellsTheError) {
  double normalised = 0;
  constexpr int kFrames = 60;
  for (int i = 0; i < kFrames; ++i) {
    const SyntheticScene scene = scene_of(70, {25, -15, 10.0 * i}, 4, static_cast<unsigned>(i + 1));
    const auto found = fit(scene, render(scene));
    ASSERT_TRUE(found);
    const double sigma_px = corner_sigma_px(scene.camera, found->camera_from_tag, found->covariance, scene.tags[0].target.size_m);
    normalised += std::pow(corner_error_px(scene, *found) / sigma_px, 2) / 2 / kFrames;
  }
  std::cout << "squared error over variance: " << normalised << '\n';
  EXPECT_GT(normalised, 0.25);
  EXPECT_LT(normalised, 1.0);
}

TEST(DirectRefinement, TellsTheTagsWhiteBlackAndNoise) {
  SyntheticScene scene = scene_of(90, {20, 20, 0}, 5);
  scene.white_linear = 0.42;
  scene.black_linear = 0.05;
  const auto found = fit(scene, render(scene));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->white_linear, 0.42, 0.004);
  EXPECT_NEAR(found->black_linear, 0.05, 0.002);
  EXPECT_NEAR(found->noise_codes, 5, 0.4);
  EXPECT_GT(found->inlier_share, 0.99);
  EXPECT_EQ(found->occluded_share, 0);
}

/// The renderer blurs by a Gaussian, and the pixel's square adds 1/12 px².
TEST(DirectRefinement, TellsTheBlur) {
  for (const double blur_px : {0.5, 1.0, 2.0, 3.0}) {
    SyntheticScene scene = scene_of(110, {20, -10, 30}, 1);
    scene.blur_px = blur_px;
    const auto found = fit(scene, render(scene));
    ASSERT_TRUE(found) << blur_px;
    const double expected_px2 = blur_px * blur_px + 1.0 / 12;
    EXPECT_NEAR(found->blur_px2.xx, expected_px2, 0.05 * expected_px2) << blur_px;
    EXPECT_NEAR(found->blur_px2.yy, expected_px2, 0.05 * expected_px2) << blur_px;
    EXPECT_NEAR(found->blur_px2.xy, 0, 0.04 * expected_px2) << blur_px;
  }
}

TEST(DirectRefinement, LimitedRangeLumaIsReadAsSuch) {
  const SyntheticScene scene = scene_of(80, {40, 10, 20});
  const SyntheticFrame frame = render(scene);
  std::vector<std::uint8_t> limited;
  for (const float light : frame.linear)
    limited.push_back(static_cast<std::uint8_t>(std::lround(16 + 219 * srgb_from_linear(light))));
  const LumaView luma{limited.data(), frame.width_px, frame.height_px, frame.width_px, 16, 235};
  const auto found = DirectRefiner(scene.camera, scene.tags[0].target).refine(luma, {disturbed(scene)});
  ASSERT_TRUE(found);
  EXPECT_LT(corner_error_px(scene, *found), 0.01);
  EXPECT_NEAR(found->white_linear, scene.white_linear, 0.01);
}

/// Light that falls off across the tag leans on every edge; the model has a slope for it.
TEST(DirectRefinement, ShadingAcrossTheTagDoesNotMoveIt) {
  const SyntheticScene scene = scene_of(100, {25, -20, 15});
  SyntheticFrame frame = render(scene);
  for (int y = 0; y < frame.height_px; ++y)
    for (int x = 0; x < frame.width_px; ++x)
      frame.linear[static_cast<std::size_t>(y * frame.width_px + x)] *= 0.6f + 0.004f * static_cast<float>(x);
  frame.codes = expose(frame.linear, 0, 1);
  const auto found = fit(scene, frame);
  ASSERT_TRUE(found);
  EXPECT_LT(corner_error_px(scene, *found), 0.015);
}

void paint(SyntheticFrame& frame, int left, int top, int width, int height, std::uint8_t code) {
  for (int y = top; y < top + height; ++y)
    for (int x = left; x < left + width; ++x) frame.codes[static_cast<std::size_t>(y * frame.width_px + x)] = code;
}

TEST(DirectRefinement, AHighlightOnTheTagCostsLittle) {
  const SyntheticScene scene = scene_of(100, {20, 10, 0}, 2);
  SyntheticFrame frame = render(scene);
  paint(frame, 100, 80, 25, 20, 255);
  const auto found = fit(scene, frame);
  ASSERT_TRUE(found);
  EXPECT_TRUE(is_convincing(*found));
  EXPECT_LT(corner_error_px(scene, *found), 0.03);
}

TEST(DirectRefinement, WhatIsNotTheTagDoesNotConvince) {
  SyntheticScene scene = scene_of(80, {20, 10, 0}, 3);
  const auto convinces = [&](const SyntheticFrame& frame) {
    const auto found = fit(scene, frame);
    return found && is_convincing(*found);
  };
  EXPECT_TRUE(convinces(render(scene)));
  SyntheticScene another = scene, none = scene, turned = scene;
  another.tags[0].target.id = 17;
  none.tags.clear();
  turned.tags[0].camera_from_tag = tag_pose(scene.camera, {118.3, 101.7}, 1000 * 0.08 / 80, {20, 10, 90});
  EXPECT_FALSE(convinces(render(another))) << "another id of the family";
  EXPECT_FALSE(convinces(render(none))) << "an empty picture";
  EXPECT_FALSE(convinces(render(turned))) << "the same print a quarter turn on";
}

TEST(DirectRefinement, ACoarseLookReachesFarther) {
  const SyntheticScene scene = scene_of(110, {20, 10, 30}, 2);
  const SyntheticFrame frame = render(scene);
  RigidTransform start = scene.tags[0].camera_from_tag;
  start.translation_m += glm::dvec3(5, -4, 0) * start.translation_m.z / scene.camera.fx_px;
  const auto found = DirectRefiner(scene.camera, scene.tags[0].target).refine(frame.luma(), {start, {0.5, 0, 0.5}, 6});
  ASSERT_TRUE(found);
  EXPECT_LT(corner_error_px(scene, *found), 0.03);
}

TEST(DirectRefinement, TheOtherPlanarPoseIsOfferedOnlyWhereThePixelsLeaveDoubt) {
  const auto offers_other = [](double side_px, double tilt_deg, double noise_codes) {
    const SyntheticScene scene = scene_of(side_px, {tilt_deg, 0, 0}, noise_codes);
    const SyntheticFrame frame = render(scene);
    DirectRefiner refiner(scene.camera, scene.tags[0].target);
    auto found = refiner.refine(frame.luma(), {scene.tags[0].camera_from_tag});
    return found && refiner.other_pose(*found).has_value();
  };
  EXPECT_FALSE(offers_other(100, 40, 2)) << "a large, tilted tag has one pose";
  EXPECT_TRUE(offers_other(30, 12, 10)) << "a small, noisy, nearly frontal one has two";
}

/// Six tags in two rows, of which only the joint fit sees the whole.
TEST(DirectRefinement, ABoardHasOneJointPose) {
  SyntheticScene scene = scene_of(34, {25, -20, 10}, 3);
  TagTarget board = scene.tags[0].target;
  const RigidTransform camera_from_tag = scene.tags[0].camera_from_tag;
  for (int i = 1; i < 6; ++i) {
    const RigidTransform tag_from_this{glm::dmat3(1.0), {0.11 * (i % 3), -0.11 * (i / 3), 0}};
    board.bundle.push_back({{"tag36h11", i, 0.08}, tag_from_this});
    scene.tags.push_back({{{"tag36h11", i, 0.08}, {}}, camera_from_tag * tag_from_this});
  }
  const SyntheticFrame frame = render(scene);
  const auto alone = DirectRefiner(scene.camera, scene.tags[0].target).refine(frame.luma(), {camera_from_tag});
  const auto joint = DirectRefiner(scene.camera, board).refine(frame.luma(), {camera_from_tag});
  ASSERT_TRUE(alone && joint);
  EXPECT_LT(turn_between_deg(joint->camera_from_tag, camera_from_tag), turn_between_deg(alone->camera_from_tag, camera_from_tag));
  EXPECT_LT(turn_between_deg(joint->camera_from_tag, camera_from_tag), 0.15);
  EXPECT_LT(joint->covariance[0], alone->covariance[0] / 4);
}

}  // namespace
}  // namespace catchlight::tracking
