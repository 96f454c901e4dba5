// The focal length that a tag's own perspective shows, on pictures rendered through a known camera.
#include "tracking/camera/focal_length.hpp"
#include "catchlight/tag.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/camera/camera_file.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

constexpr double kSize_m = 0.08;

CameraModel camera_of(double fx_px) {
  CameraModel camera = plain_camera();
  camera.fx_px = camera.fy_px = fx_px;
  return camera;
}

struct Picture {
  SyntheticFrame frame;
  Quad corners_px;
};

/// The tag tilted by `tilt_deg` while it turns, 150 px wide.
std::vector<Picture> swing(const CameraModel& camera, double tilt_deg, double turn_deg, int count = 9) {
  std::vector<Picture> pictures;
  for (int i = 0; i < count; ++i) {
    SyntheticScene scene;
    scene.camera = camera;
    scene.noise_codes = 1;
    scene.seed = static_cast<unsigned>(i + 1);
    const RigidTransform pose = tag_pose(camera, {320, 240}, kSize_m * camera.fx_px / 150, {tilt_deg, 0, turn_deg * i / count});
    scene.tags = {{TagTarget{{"tag36h11", 5, kSize_m}, {}}, pose}};
    pictures.push_back({render(scene), true_corners_px(camera, scene.tags.front())});
  }
  return pictures;
}

std::optional<FocalEstimate> estimate(const std::vector<Picture>& pictures, const CameraModel& assumed, double off_px = 0) {
  FocalMeter meter(assumed, {"tag36h11", 5, kSize_m});
  for (const auto& [frame, corners_px] : pictures) {
    Quad about_px = corners_px;
    about_px[0].x += off_px;
    about_px[2].y -= off_px;
    meter.add(frame.luma(), about_px);
  }
  return meter.estimate();
}

class FocalLengthOf : public ::testing::TestWithParam<double> {};

TEST_P(FocalLengthOf, ATiltedTagThatTurnsIsFoundFromAnyGuess) {
  const double truth_px = GetParam();
  const std::vector<Picture> pictures = swing(camera_of(truth_px), 45, 330);
  for (const double guess : {0.6, 1.0, 1.7}) {
    const auto seen = estimate(pictures, camera_of(guess * truth_px), guess == 1.0 ? 0 : 6);
    ASSERT_TRUE(seen) << guess;
    EXPECT_NEAR(seen->fx_px, truth_px, 0.01 * truth_px) << guess;
    EXPECT_NEAR(seen->fx_px, truth_px, 2 * seen->deviation_px) << guess;
    EXPECT_LT(seen->deviation_px, 0.04 * truth_px) << guess;
    EXPECT_EQ(seen->looks, 9) << guess;
  }
}

INSTANTIATE_TEST_SUITE_P(Px, FocalLengthOf, ::testing::Values(400.0, 900.0));

TEST(FocalLength, IsFoundThroughTheLensThatTheCameraFileDescribes) {
  const CameraModel truth = distorted_camera();
  const auto seen = estimate(swing(truth, 40, 330), truth);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->fx_px, truth.fx_px, 0.01 * truth.fx_px);
}

TEST(FocalLength, IsNotToldByAFrontalTag) {
  EXPECT_FALSE(estimate(swing(camera_of(600), 3, 330), camera_of(600)));
}

TEST(FocalLength, IsNotToldByATagThatStandsStill) {
  EXPECT_FALSE(estimate(swing(camera_of(600), 45, 0), camera_of(600)));
}

TEST(FocalLength, KeepsFewLooksOfLongFootage) {
  const std::vector<Picture> pictures = swing(camera_of(600), 45, 350, 30);
  const auto seen = estimate(pictures, camera_of(600));
  ASSERT_TRUE(seen);
  EXPECT_LE(seen->looks, 20);
  EXPECT_GE(seen->looks, 8);
}

TEST(FocalLength, FieldOfViewIsTheInverseOfTheCameraMadeOfIt) {
  EXPECT_NEAR(horizontal_fov_deg(camera_from_field_of_view(1920, 1080, 47.5)), 47.5, 1e-9);
}

}  // namespace
}  // namespace catchlight::tracking
