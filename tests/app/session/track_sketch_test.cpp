// Lines over a picture are where the lens shows what they stand for.
#include "app/session/track_sketch.hpp"

#include <gmock/gmock.h>

#include "catchlight/tag.hpp"
#include "tests/support/synthetic_tag.hpp"

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;

constexpr double kTag_m = 0.08;

const CameraModel kCamera = tracking::distorted_camera();
const RigidTransform kPose = tracking::tag_pose(kCamera, {400, 300}, 0.4, {30, 20, 10});

TEST(TrackSketch, TheOutlineGoesFromCornerToCorner) {
  const auto corners_px = tracking::true_corners_px(kCamera, {{{"tag36h11", 5, kTag_m}, {}}, kPose});
  const std::vector<Stroke> strokes = outline_strokes(kCamera, kPose, kTag_m);
  ASSERT_EQ(strokes.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(glm::distance(strokes[i].points_px.front(), corners_px[i]), 1e-3) << i;
    EXPECT_LT(glm::distance(strokes[i].points_px.back(), corners_px[(i + 1) % 4]), 1e-3) << i;
  }
}

TEST(TrackSketch, AxesBeginInTheMiddleInTheirColours) {
  const CameraModel plain = tracking::plain_camera();
  const auto pose = tracking::tag_pose(plain, {400, 300}, 0.4, {30, 20, 10});
  const std::vector<Stroke> axes = axis_strokes(plain, pose, kTag_m);
  ASSERT_EQ(axes.size(), 3u);
  for (const Stroke& axis : axes) EXPECT_LT(glm::distance(axis.points_px.front(), glm::dvec2(400, 300)), 1e-6);
  EXPECT_EQ(axes[0].color, (Rgb{255, 0, 0}));
  EXPECT_EQ(axes[2].color, (Rgb{0, 0, 255}));
}

TEST(TrackSketch, NothingIsDrawnOfWhatIsBehindTheCamera) {
  RigidTransform behind = kPose;
  behind.translation_m.z = -0.4;
  EXPECT_TRUE(outline_strokes(kCamera, behind, kTag_m).empty());
  EXPECT_TRUE(axis_strokes(kCamera, behind, kTag_m).empty());
  EXPECT_TRUE(corner_strokes(kCamera, behind, kTag_m, 5).empty());
}

TEST(TrackSketch, StatesHaveWordsAndColours) {
  TrackRow row;
  row.frame = 7;
  EXPECT_EQ(state_lines(row).size(), 1u);
  EXPECT_THAT(state_lines(row)[0].text, HasSubstr("frame 7  lost"));
  const Rgb lost = state_lines(row)[0].color;
  row.state = TrackState::tracking, row.found = true, row.corner_sigma_px = 0.012;
  ASSERT_EQ(state_lines(row).size(), 2u);
  EXPECT_NE(state_lines(row)[0].color, lost);
  EXPECT_THAT(state_lines(row)[1].text, HasSubstr("+-0.012 px"));
}

}  // namespace
}  // namespace catchlight::app
