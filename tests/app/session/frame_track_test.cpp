// Rows of the track from rendered frames: what is found where, and whose exposure a row has.
#include "app/session/frame_track.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tests/support/exposure_fixture.hpp"
#include "tests/support/synthetic_tag.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace catchlight::app {
namespace {

using testing::noise_frame;
using testing::scene_of_tag_5;
using testing::small_camera;

/// The tag with its centre at `x_px`, or none; `light` is what white paper on it sends.
Frame frame_of(std::int64_t number, std::optional<double> x_px, double light = 0.6) {
  tracking::SyntheticScene synthetic{small_camera(), {}};
  if (x_px) {
    const TagTarget target{{"tag36h11", 5, 0.08}, {}};
    synthetic.tags = {{target, tracking::tag_pose(small_camera(), {*x_px, 80}, 1.3, {25, 15, 0})}};
  }
  synthetic.white_linear = light;
  synthetic.black_linear = light / 20;
  synthetic.noise_codes = 1;
  synthetic.seed = static_cast<unsigned>(number);
  const std::vector<std::uint8_t> codes = tracking::render(synthetic).codes;
  FramePtr picture = noise_frame(AV_PIX_FMT_RGB24, 200, 160, 1);
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 200; ++x)
      std::fill_n(picture->data[0] + y * picture->linesize[0] + 3 * x, 3, codes[static_cast<std::size_t>(y * 200 + x)]);
  return {std::shared_ptr<const AVFrame>(std::move(picture)), number, static_cast<double>(number) / 30};
}

std::vector<TrackRow> solved(const std::vector<Frame>& frames) {
  ShotTrack track(small_camera(), scene_of_tag_5());
  for (const Frame& frame : frames) track.add(frame);
  return track.solve();
}

TEST(ShotTrack, ATagThatMovesOutOfThePictureIsLostThere) {
  // 40 px a frame: after it was last seen, the tag is out of the picture long before its coasting time is over.
  std::vector<Frame> frames;
  for (int i = 0; i < 9; ++i) frames.push_back(frame_of(i, 60 + 40.0 * i));
  const auto rows = solved(frames);
  ASSERT_EQ(rows.size(), frames.size());
  for (const int inside : {0, 1, 2}) EXPECT_EQ(rows[static_cast<std::size_t>(inside)].state, TrackState::tracking) << inside;
  for (std::size_t i = 5; i < rows.size(); ++i) {  // from 260 px on, more than its half diagonal beyond the edge
    EXPECT_FALSE(rows[i].found) << i;
    EXPECT_EQ(rows[i].state, TrackState::lost) << i;
  }
}

TEST(ShotTrack, ATagThatIsCoveredForAMomentCoastsInPlace) {
  std::vector<Frame> frames;
  for (int i = 0; i < 10; ++i) frames.push_back(frame_of(i, i == 5 || i == 6 ? std::nullopt : std::optional(100.0)));
  const auto rows = solved(frames);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_TRUE(rows[i].found) << i;
    EXPECT_EQ(rows[i].state, i == 5 || i == 6 ? TrackState::coasting : TrackState::tracking) << i;
    EXPECT_NEAR(rows[i].camera_from_tag.translation_m.z, 1.3, 0.01) << i;
  }
}

TEST(ShotTrack, OverUnmeasuredFramesTheExposureGoesEvenlyInStops) {
  // 0 to 3 before the tag is there, 4 to 6 in dim light, 7 to 11 gone, then brighter.
  std::vector<Frame> frames;
  for (int i = 0; i < 15; ++i) {
    const bool is_there = (i >= 4 && i < 7) || i >= 12;
    frames.push_back(frame_of(i, is_there ? std::optional(100.0) : std::nullopt, i < 9 ? 0.3 : 0.6));
  }
  const auto rows = solved(frames);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rows[i].exposure, rows[4].exposure) << "nothing before: the first that is known";
  for (std::size_t i = 7; i < 12; ++i) {
    const double share = static_cast<double>(i - 6) / 6;
    EXPECT_NEAR(rows[i].exposure.g, rows[6].exposure.g * std::pow(rows[12].exposure.g / rows[6].exposure.g, share), 1e-12) << i;
  }
  EXPECT_NEAR(rows[12].exposure.g / rows[6].exposure.g, 2, 0.02) << "twice the light";
  // White and black cells of albedo 0.8 and 0.04 at 0.3 and 0.015: 0.375 per unit of albedo.
  EXPECT_NEAR(rows[4].exposure.g, (0.3 - 0.015) / (0.8 - 0.04), 0.005);
}

TEST(ShotTrack, WithoutAnyTagEveryRowIsLostAndHasTheUsualExposure) {
  const auto rows = solved({frame_of(0, std::nullopt), frame_of(1, std::nullopt)});
  ASSERT_EQ(rows.size(), 2u);
  for (const TrackRow& row : rows) {
    EXPECT_FALSE(row.found);
    EXPECT_EQ(row.exposure, glm::dvec3(0.75));
  }
}

TEST(ShotTrack, WhereTheTagIsNeverFoundWhatIsThereIsNamed) {
  SceneSettings scene = scene_of_tag_5();
  scene.tag.id = 7;
  ShotTrack other(small_camera(), scene), none(small_camera(), scene), found(small_camera(), scene_of_tag_5());
  for (int i = 0; i < 12; ++i) {
    other.add(frame_of(i, 100.0));
    none.add(frame_of(i, std::nullopt));
    found.add(frame_of(i, i == 11 ? std::optional(100.0) : std::nullopt));
  }
  EXPECT_EQ(other.never_found(),
            "the tag was never found in 12 frames; tag36h11 #7 was looked for, and tag36h11 #5 is in every frame that was looked "
            "at: give --tag.id 5");
  EXPECT_THAT(none.never_found().value(), ::testing::HasSubstr("no tag of any family is there"));
  EXPECT_EQ(found.never_found(), std::nullopt);
}

TEST(ShotTrack, RowsHaveTheFramesNumbersAndTimes) {
  const auto rows = solved({frame_of(17, 100.0), frame_of(18, 100.0)});
  EXPECT_EQ(rows[0].frame, 17);
  EXPECT_EQ(rows[1].frame, 18);
  EXPECT_EQ(rows[1].time_s, 18.0 / 30);
  EXPECT_GT(rows[1].noise_codes, 0.5) << "and say what the tag looked like";
  EXPECT_GT(rows[1].blur_px2.xx, 0.1);
  EXPECT_GT(rows[1].corner_sigma_px, 0);
}

TEST(TagTrack, LiveFootageKnowsOnlyTheFramesBefore) {
  const auto track = make_tag_track(small_camera(), scene_of_tag_5());
  EXPECT_TRUE(track->is_tracking());
  const TrackRow before = track->row(frame_of(0, std::nullopt));
  EXPECT_FALSE(before.found);
  EXPECT_EQ(before.exposure, glm::dvec3(0.75)) << "nothing was measured yet";
  EXPECT_TRUE(track->never_found());
  EXPECT_EQ(track->row(frame_of(1, 100.0)).state, TrackState::tracking);
  EXPECT_FALSE(track->never_found());
  EXPECT_EQ(track->row(frame_of(2, std::nullopt)).state, TrackState::coasting);
}

}  // namespace
}  // namespace catchlight::app
