// The tag's white and black as measured, against those it was rendered with.
#include "tracking/camera/photometry.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/track.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tests/tracking/camera/light_fixture.hpp"
#include "tracking/detection/families.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

SyntheticScene one_tag(double distance_m, const std::string& family = "tag36h11") {
  SyntheticScene scene;
  scene.camera = plain_camera();
  scene.tags.resize(1);
  scene.tags[0].target.family = family;
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {320, 240}, distance_m, {30, 20, 15});
  return scene;
}

Light light_of(const SyntheticFrame& frame, const glm::vec3& tint = glm::vec3(1), float most = 1) {
  Light light{frame.width_px, frame.height_px, {}};
  for (const float linear : frame.linear) light.rgb.push_back(glm::min(linear * tint, glm::vec3(most)));
  return light;
}

std::optional<TagPhotometry> measure(const SyntheticScene& scene, const Light& light) {
  return measure_photometry(light.view(), scene.camera, scene.tags[0].camera_from_tag, scene.tags[0].target);
}

class PhotometryOfFamily : public ::testing::TestWithParam<std::string> {};

TEST_P(PhotometryOfFamily, MeasuresWhiteAndBlackPerChannel) {
  const SyntheticScene scene = one_tag(0.35, GetParam());
  const glm::vec3 tint(0.9f, 1.0f, 0.6f);
  const auto measured = measure(scene, light_of(render(scene), tint));
  ASSERT_TRUE(measured);
  for (int channel = 0; channel < 3; ++channel) {
    // Far from every edge there is no blur: what is left is the sampling of cells at their border's blurred tail.
    EXPECT_NEAR(measured->white_linear[channel], scene.white_linear * tint[channel], 0.002);
    EXPECT_NEAR(measured->black_linear[channel], scene.black_linear * tint[channel], 0.002);
  }
  EXPECT_GT(measured->white_pixels, 100);
  EXPECT_GT(measured->black_pixels, 100);
}

INSTANTIATE_TEST_SUITE_P(Library, PhotometryOfFamily, ::testing::ValuesIn(tag_families()),
                         [](const auto& family) { return family.param; });

TEST(Photometry, LooksThroughTheLens) {
  SyntheticScene scene = one_tag(0.3);
  scene.camera = distorted_camera();
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {150, 130}, 0.3, {30, 20, 15});
  const auto measured = measure(scene, light_of(render(scene)));
  ASSERT_TRUE(measured);
  EXPECT_NEAR(measured->white_linear.g, scene.white_linear, 0.002);
  EXPECT_NEAR(measured->black_linear.g, scene.black_linear, 0.002);
}

TEST(Photometry, AHighlightOnAFewCellsDoesNotCount) {
  const SyntheticScene scene = one_tag(0.35);
  SyntheticFrame frame = render(scene);
  for (int y = 225; y < 245; ++y)
    for (int x = 300; x < 320; ++x) frame.linear[static_cast<std::size_t>(y * frame.width_px + x)] = 0.9f;
  const auto measured = measure(scene, light_of(frame));
  ASSERT_TRUE(measured);
  EXPECT_NEAR(measured->white_linear.g, scene.white_linear, 0.005);
  EXPECT_NEAR(measured->black_linear.g, scene.black_linear, 0.005);
}

TEST(Photometry, ClippedWhiteIsNotTrusted) {
  SyntheticScene scene = one_tag(0.35);
  scene.white_linear = 1.3;
  EXPECT_EQ(measure(scene, light_of(render(scene)))->is_clipped, glm::bvec3(true)) << "all channels";
  scene.white_linear = 0.6;
  const auto one = measure(scene, light_of(render(scene), {0.5f, 2.0f, 0.5f}));
  EXPECT_EQ(one->is_clipped, glm::bvec3(false, true, false));
  EXPECT_NEAR(one->white_linear.r, 0.3, 0.002) << "the others are as good as ever";
  EXPECT_NEAR(one->black_linear.g, 0.06, 0.002) << "and so is black";
  EXPECT_EQ(measure(scene, light_of(render(scene), {1.5f, 1.5f, 1.5f}))->is_clipped, glm::bvec3(false)) << "bright, not clipped";
}

TEST(Photometry, AFifthOfTheTagClippedByAHighlightDoesNotCount) {
  const SyntheticScene scene = one_tag(0.35);
  SyntheticFrame frame = render(scene);
  const PixelRect region = photometry_region(scene.camera, scene.tags[0].camera_from_tag, {});
  for (int y = region.y; y < region.y + region.height / 5; ++y)
    for (int x = region.x; x < region.x + region.width; ++x)
      frame.linear[static_cast<std::size_t>(y * frame.width_px + x)] = 5.0f;
  const auto measured = measure(scene, light_of(frame));
  ASSERT_TRUE(measured);
  EXPECT_EQ(measured->is_clipped, glm::bvec3(false));
  EXPECT_NEAR(measured->white_linear.g, scene.white_linear, 0.005);
}

/// What the sensor is said to clip at decides, not sRGB's.
TEST(Photometry, LightBeyondOneIsMeasuredWhereTheFootageHoldsIt) {
  SyntheticScene scene = one_tag(0.35);
  scene.white_linear = 4;
  const SyntheticFrame frame = render(scene);
  const auto measured = measure_photometry(light_of(frame, glm::vec3(1), 40).view(40), scene.camera,
                                           scene.tags[0].camera_from_tag, scene.tags[0].target);
  ASSERT_TRUE(measured);
  EXPECT_EQ(measured->is_clipped, glm::bvec3(false));
  EXPECT_NEAR(measured->white_linear.g, 4, 0.02);
}

TEST(Photometry, ABlackFrameAndAWhiteFrameHaveNoMeasure) {
  const SyntheticScene scene = one_tag(0.35);
  SyntheticFrame frame = render(scene);
  for (const float light : {0.0f, 1.0f}) {
    std::fill(frame.linear.begin(), frame.linear.end(), light);
    EXPECT_FALSE(measure(scene, light_of(frame))) << light;
  }
}

TEST(Photometry, ATagWithCellsOfTwoPixelsIsTooSmall) {
  const SyntheticScene scene = one_tag(600 * 0.08 / 16);
  EXPECT_FALSE(measure(scene, light_of(render(scene))));
}

TEST(Photometry, WithTheBlurKnownEvenCellsOfTwoPixelsAreUnmixed) {
  const glm::vec3 tint(0.9f, 1.0f, 0.6f);
  SyntheticScene scene = one_tag(2.4);
  ASSERT_FALSE(measure(scene, light_of(render(scene), tint)));
  const double blur_px2 = scene.blur_px * scene.blur_px + 1.0 / 12;
  const Light light = light_of(render(scene), tint);
  const auto unmixed = measure_photometry(light.view(), scene.camera, scene.tags[0].camera_from_tag, scene.tags[0].target,
                                          Covariance2{blur_px2, 0, blur_px2});
  ASSERT_TRUE(unmixed);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(unmixed->white_linear[channel], scene.white_linear * tint[channel], 0.02 * scene.white_linear);
    EXPECT_NEAR(unmixed->black_linear[channel], scene.black_linear * tint[channel], 0.02 * scene.white_linear);
  }
}

TEST(Photometry, ATagHalfOutOfTheFrameIsMeasuredByWhatIsSeen) {
  SyntheticScene scene = one_tag(0.35);
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {5, 240}, 0.35, {0, 0, 0});
  const Light light = light_of(render(scene));
  EXPECT_EQ(photometry_region(scene.camera, scene.tags[0].camera_from_tag, scene.tags[0].target).x, 0);
  const auto measured = measure(scene, light);
  ASSERT_TRUE(measured);
  EXPECT_NEAR(measured->white_linear.g, scene.white_linear, 0.002);
}

TEST(Photometry, ATagOutOfSightHasNoRegionAndNoMeasure) {
  SyntheticScene scene = one_tag(0.35);
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {-500, 240}, 0.35, {0, 0, 0});
  EXPECT_TRUE(photometry_region(scene.camera, scene.tags[0].camera_from_tag, {}).empty());
  scene.tags[0].camera_from_tag.translation_m.z = -1;
  EXPECT_TRUE(photometry_region(scene.camera, scene.tags[0].camera_from_tag, {}).empty());
  EXPECT_FALSE(measure(scene, {}));
}

TEST(Photometry, TheRegionHoldsTheWholeTag) {
  const SyntheticScene scene = one_tag(0.35);
  const PixelRect region = photometry_region(scene.camera, scene.tags[0].camera_from_tag, {});
  for (const glm::dvec2& corner : true_corners_px(scene.camera, scene.tags[0])) {
    EXPECT_GE(corner.x, region.x);
    EXPECT_GE(corner.y, region.y);
    EXPECT_LE(corner.x, region.x + region.width - 1);
    EXPECT_LE(corner.y, region.y + region.height - 1);
  }
}

TEST(Photometry, UniformLightHasNoWhiteAndBlack) {
  const SyntheticScene scene = one_tag(0.35);
  SyntheticFrame frame = render(scene);
  std::fill(frame.linear.begin(), frame.linear.end(), 0.3f);
  EXPECT_FALSE(measure(scene, light_of(frame)));
}

}  // namespace
}  // namespace catchlight::tracking
