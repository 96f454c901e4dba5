// What is said of how large objects are.
#include "app/session/object_scale.hpp"

#include <gmock/gmock.h>

namespace catchlight::app {
namespace {

using testing::HasSubstr;

CameraModel camera() {
  return {.width_px = 640, .height_px = 480, .fx_px = 500, .fy_px = 500, .cx_px = 320, .cy_px = 240};
}

/// The camera looks straight down at the tag.
RigidTransform camera_above(double height_m) {
  return {glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1)), {0, 0, height_m}};
}

render::Bounds box(const glm::vec3& size_m) {
  return {{-size_m.x / 2, -size_m.y / 2, 0}, {size_m.x / 2, size_m.y / 2, size_m.z}};
}

std::string warning(const render::Bounds& bounds, double height_m) {
  return scale_warning(bounds, camera(), camera_above(height_m)).value_or("");
}

TEST(ObjectScale, IsSaidInUnitsThatFit) {
  EXPECT_EQ(scale_text(box({0.098f, 0.074f, 0.083f}), 0.14, camera_above(0.72)),
            "object 98 × 74 × 83 mm on a tag of 140 mm, 0.72 m away");
  EXPECT_EQ(scale_text(box({0.0042f, 0.001f, 0.0083f}), 0.008, camera_above(0.1)),
            "object 4.2 × 1.0 × 8.3 mm on a tag of 8.0 mm, 0.10 m away");
  EXPECT_EQ(scale_text(box({2, 0.5f, 1.25f}), 1.5, camera_above(12)),
            "object 2.00 × 0.50 × 1.25 m on a tag of 1.50 m, 12.00 m away");
}

TEST(ObjectScale, OfVerySmallAndVeryLargeOnesHasDigitsThatMatter) {
  EXPECT_THAT(scale_text(box({0.000013f, 0.000009f, 0.000008f}), 0.08, camera_above(1)), HasSubstr("0.013 × 0.009 × 0.008 mm"));
  EXPECT_THAT(scale_text(box({128.37f, 91.95f, 80}), 0.08, camera_above(1)), HasSubstr("128 × 92 × 80 m on"));
}

TEST(ObjectScale, OfUsualSizeIsNoWarning) {
  EXPECT_EQ(warning(box(glm::vec3(0.08f)), 0.7), "");
  EXPECT_EQ(warning(box(glm::vec3(0.4f)), 0.7), "") << "a close-up that fills the frame";
  EXPECT_EQ(warning(box(glm::vec3(0.004f)), 0.7), "") << "some pixels";
}

TEST(ObjectScale, OfAnotherUnitIsWarnedOf) {
  EXPECT_THAT(warning(box(glm::vec3(60)), 0.7), HasSubstr("the camera is inside the object, 60 × 60 × 60 m large"));
  EXPECT_THAT(warning(box(glm::vec3(60)), 0.7), HasSubstr("0.001 for a model in millimetres"));
  EXPECT_THAT(warning(box({60, 60, 0.1f}), 0.7), HasSubstr("more than the frame")) << "a sheet below the camera";
  EXPECT_THAT(warning(box(glm::vec3(0.00008f)), 0.7), HasSubstr("smaller than a pixel"));
}

}  // namespace
}  // namespace catchlight::app
