// How far a drawn pose is off, by what one frame shows.
#include "app/session/corner_residuals.hpp"

#include <gtest/gtest.h>

#include "tests/support/exposure_fixture.hpp"
#include "tests/support/synthetic_tag.hpp"

namespace catchlight::app {
namespace {

using testing::noise_frame;
using testing::scene_of_tag_5;

const CameraModel kCamera = tracking::plain_camera();
const tracking::SyntheticTag kTag{{{"tag36h11", 5, 0.08}, {}}, tracking::tag_pose(kCamera, {300, 240}, 0.4, {25, 15, 0})};

Frame frame_with(const std::vector<tracking::SyntheticTag>& tags) {
  const std::vector<std::uint8_t> codes = tracking::render({kCamera, tags}).codes;
  FramePtr picture = noise_frame(AV_PIX_FMT_GRAY8, kCamera.width_px, kCamera.height_px, 1);
  for (int y = 0; y < kCamera.height_px; ++y)
    std::copy_n(&codes[static_cast<std::size_t>(y) * kCamera.width_px], kCamera.width_px,
                picture->data[0] + y * picture->linesize[0]);
  return {std::shared_ptr<const AVFrame>(std::move(picture)), 0, 0};
}

TrackRow row_at(const RigidTransform& camera_from_tag) {
  TrackRow row;
  row.found = true, row.state = TrackState::tracking, row.camera_from_tag = camera_from_tag;
  return row;
}

TEST(CornerResiduals, AreSmallForThePoseThatTheFrameShows) {
  const auto residuals = corner_residuals(frame_with({kTag}), row_at(kTag.camera_from_tag), kCamera, scene_of_tag_5());
  ASSERT_EQ(residuals.size(), 1u);
  EXPECT_EQ(residuals[0].id, 5);
  EXPECT_LT(rms_px(residuals), 0.1);
}

TEST(CornerResiduals, SayHowFarAndWhereToAPoseIsOff) {
  RigidTransform off = kTag.camera_from_tag;
  off.translation_m.x += 3 * off.translation_m.z / kCamera.fx_px;  // 3 px to the right, nearly
  const auto residuals = corner_residuals(frame_with({kTag}), row_at(off), kCamera, scene_of_tag_5());
  ASSERT_EQ(residuals.size(), 1u);
  EXPECT_NEAR(rms_px(residuals), 3, 0.3);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(residuals[0].seen_px[i].x, residuals[0].drawn_px[i].x) << i;
}

TEST(CornerResiduals, ThereAreNoneWithoutAPoseOrATag) {
  EXPECT_TRUE(corner_residuals(frame_with({kTag}), TrackRow{}, kCamera, scene_of_tag_5()).empty());
  EXPECT_TRUE(corner_residuals(frame_with({}), row_at(kTag.camera_from_tag), kCamera, scene_of_tag_5()).empty());
  EXPECT_EQ(rms_px({}), 0);
}

}  // namespace
}  // namespace catchlight::app
