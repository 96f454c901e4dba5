// A few whole pictures, and the comparator that guards them.
#include "catchlight/color.hpp"
#include "catchlight/composite.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/renderers.hpp"
#include "tests/support/studio.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace catchlight::render::test {
namespace {

class GoldenGl : public GlTest {};

/// The plate with the composite in it, 8-bit BGR.
cv::Mat picture(Compositor&& compositor, const FrameView& view) {
  cv::Mat result(view.camera.height_px, view.camera.width_px, CV_8UC3);
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      const glm::ivec3 code = table(x, y);
      result.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<uchar>(code.b), static_cast<uchar>(code.g), static_cast<uchar>(code.r));
    }
  }
  const Composite composite = compositor.render(view, plate_u8(table));
  for (int y = composite.rect.y; y < composite.rect.y + composite.rect.height; ++y) {
    for (int x = composite.rect.x; x < composite.rect.x + composite.rect.width; ++x) {
      const glm::vec4 pixel = pixel_at(composite, x, y);
      if (pixel.a == 0) continue;
      for (int c = 0; c < 3; ++c) result.at<cv::Vec3b>(y, x)[2 - c] = cv::saturate_cast<uchar>(std::lround(255 * pixel[c]));
    }
  }
  return result;
}

/// OpenGL's picture is the golden one, and the processor's as near to it as the two must be in any frame.
void expect_golden(const std::string& name, const RenderScene& scene, const FrameView& view, const CompositorSettings& settings) {
  const cv::Mat gl = picture(GlCompositor(scene, settings), view), cpu = picture(CpuCompositor(scene, settings), view);
  EXPECT_TRUE(matches_golden(gl, name, golden_tolerance()));
  cv::Mat apart, channels[3];
  cv::absdiff(gl, cpu, apart);
  cv::split(apart, channels);
  const cv::Mat largest = cv::max(cv::max(channels[0], channels[1]), channels[2]);
  EXPECT_LE(cv::mean(largest)[0], 0.3);
  EXPECT_LE(cv::countNonZero(largest > 2), static_cast<int>(largest.total() / 100)) << "pixels, of which 1 % may differ by more";
}

TEST_F(GoldenGl, MatteBallWithItsShadow) {
  RenderScene scene = ball(material_of({0.8f, 0.35f, 0.2f}, 0, 1, 0));
  const auto shadow = [](double x, double y) {
    return 1 - 0.75 * std::exp(-((x - 0.015) * (x - 0.015) + (y + 0.006) * (y + 0.006)) / 0.0018);
  };
  add_receiver(scene.transfer, {.min_m = {-0.15f, -0.15f}, .max_m = {0.15f, 0.15f}, .columns = 49, .rows = 49}, shadow);
  expect_golden("matte_ball", scene, tilted_view(), without_glare());
}

TEST_F(GoldenGl, MirrorBallWithGlare) {
  expect_golden("mirror_ball", ball(material_of(glm::vec3(0.95f), 1, 0, 0.04f)), tilted_view(), {});
}

TEST_F(GoldenGl, PlasticBallThroughABarrelLens) {
  FrameView view = tilted_view();
  view.camera.distortion = {-0.9, 0.5, 0.01, -0.01, 0, 0, 0, 0};
  view.camera_from_tag.translation_m = {0.06, 0.02, 0.3};
  expect_golden("plastic_ball", ball(material_of({0.1f, 0.3f, 0.6f}, 0, 0, 0.04f)), view, without_glare());
}

class GoldenComparator : public ::testing::Test {
 protected:
  static bool accepts(const cv::Mat& changed) { return within(image_difference(changed, original()), kSoftwareTolerance); }
  static cv::Mat original() { return cv::imread(std::string(CATCHLIGHT_SOURCE_DIR) + "/tests/golden/matte_ball.png"); }
};

TEST_F(GoldenComparator, AcceptsTheSamePictureAndOneCodeOfRounding) {
  cv::Mat rounded = original();
  ASSERT_FALSE(rounded.empty());
  for (int x = 3; x < rounded.cols; x += 40) rounded.at<cv::Vec3b>(60, x)[1] += 1;
  EXPECT_TRUE(accepts(original()));
  EXPECT_TRUE(accepts(rounded));
}

TEST_F(GoldenComparator, RefusesAShiftByOnePixel) {
  cv::Mat shifted;
  cv::warpAffine(original(), shifted, cv::Matx23d(1, 0, 1, 0, 1, 0), original().size(), cv::INTER_NEAREST, cv::BORDER_REPLICATE);
  EXPECT_FALSE(accepts(shifted));
}

TEST_F(GoldenComparator, RefusesABlankedObject) {
  cv::Mat blanked = original();
  cv::circle(blanked, {100, 80}, 25, cv::Scalar(90, 105, 120), cv::FILLED);
  EXPECT_FALSE(accepts(blanked));
}

TEST_F(GoldenComparator, RefusesSwappedRedAndBlue) {
  cv::Mat swapped;
  cv::cvtColor(original(), swapped, cv::COLOR_BGR2RGB);
  EXPECT_FALSE(accepts(swapped));
}

TEST_F(GoldenComparator, RefusesAPictureUpsideDown) {
  cv::Mat flipped;
  cv::flip(original(), flipped, 0);
  EXPECT_FALSE(accepts(flipped));
}

TEST_F(GoldenComparator, RefusesTwoPercentMoreExposure) {
  cv::Mat brighter = original();
  for (int i = 0; i < static_cast<int>(brighter.total() * 3); ++i) {
    uchar& code = brighter.data[i];
    code = cv::saturate_cast<uchar>(std::lround(255 * srgb_from_linear(1.02 * linear_from_srgb(code / 255.0))));
  }
  EXPECT_FALSE(accepts(brighter));
}

TEST_F(GoldenComparator, AMissingGoldenFailsAndSaysHowToBless) {
  if (std::getenv("CATCHLIGHT_BLESS")) GTEST_SKIP() << "would bless it";
  const auto result = matches_golden(original(), "never_made", kSoftwareTolerance);
  EXPECT_FALSE(result);
  EXPECT_THAT(result.message(),
              ::testing::AllOf(::testing::HasSubstr("never_made.png"), ::testing::HasSubstr("CATCHLIGHT_BLESS=1")));
}

}  // namespace
}  // namespace catchlight::render::test
