// Rendered footage whose exposure and white balance wander: the track has to follow in every frame and channel.
#include <algorithm>
#include <cmath>
#include <random>

#include "app/session/frame_track.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tests/support/exposure_fixture.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/camera/camera_file.hpp"

namespace catchlight::app {
namespace {

using testing::noise_frame;
using testing::reexposed;
using testing::scene_of_tag_5;
using testing::small_camera;

/// What a sensor keeps of one unit of linear light.
constexpr double kNoisePerLight = 2.3e-4;

/// Light of a tag of `size_px` pixels on paper of a margin of one cell; albedo 0.8 comes out at 0.6.
std::vector<float> tag_light(double size_px = 61) {
  tracking::SyntheticScene synthetic{small_camera(), {}};
  const TagTarget target{{"tag36h11", 5, 0.08}, {}};
  synthetic.tags = {{target, tracking::tag_pose(small_camera(), {100, 80}, 1000 * 0.08 / size_px, {25, 15, 0})}};
  synthetic.white_linear = 0.6;
  synthetic.black_linear = 0.03;
  return tracking::render(synthetic).linear;
}

/// The light through a camera with these gains: noise, clipping, sRGB codes.
Frame photograph(const std::vector<float>& light, const glm::dvec3& gain, std::int64_t number) {
  std::mt19937 random(static_cast<unsigned>(1000 + number));
  std::normal_distribution<double> normal;
  FramePtr picture = noise_frame(AV_PIX_FMT_RGB24, 200, 160, 1);
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 200; ++x)
      for (int c = 0; c < 3; ++c) {
        const double exposed = light[static_cast<std::size_t>(y * 200 + x)] * gain[c];
        const double seen = std::clamp(exposed + std::sqrt(kNoisePerLight * exposed) * normal(random), 0.0, 1.0);
        picture->data[0][y * picture->linesize[0] + 3 * x + c] =
            static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(seen)));
      }
  return {std::shared_ptr<const AVFrame>(std::move(picture)), number, static_cast<double>(number) / 24};
}

/// From 0 EV over `top_ev` to `-top_ev` and back, in steps of a quarter stop, the white balance off by up to 20 % either way.
std::vector<glm::dvec3> wandering_gains(double top_ev) {
  const int steps = static_cast<int>(16 * top_ev);
  std::vector<glm::dvec3> gains;
  for (int i = 0; i <= steps; ++i) {
    const double turn = static_cast<double>(i) / steps, triangle = std::asin(std::sin(2 * M_PI * turn)) / (M_PI / 2);
    const double warm = 0.2 * std::sin(2 * M_PI * 1.3 * turn + 0.4), cold = 0.2 * std::sin(2 * M_PI * 0.9 * turn + 1.1);
    gains.push_back(std::exp2(top_ev * triangle) * glm::dvec3(1 + warm, 1, 1 - cold));
  }
  return gains;
}

std::vector<TrackRow> solved(const std::vector<Frame>& frames) {
  ShotTrack track(small_camera(), scene_of_tag_5());
  for (const Frame& frame : frames) track.add(frame);
  return track.solve();
}

std::vector<TrackRow> causal(const std::vector<Frame>& frames) {
  const auto track = make_tag_track(small_camera(), scene_of_tag_5());
  std::vector<TrackRow> rows;
  for (const Frame& frame : frames) rows.push_back(track->row(frame));
  return rows;
}

void expect_within(const std::vector<TrackRow>& rows, const std::vector<glm::dvec3>& gains, double tolerance) {
  ASSERT_EQ(rows.size(), gains.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(rows[i].exposure[c] / (0.75 * gains[i][c]), 1, tolerance)
          << "frame " << i << " channel " << c << " gain " << gains[i][c];
}

std::vector<Frame> photographs(const std::vector<float>& light, const std::vector<glm::dvec3>& gains) {
  std::vector<Frame> frames;
  for (const glm::dvec3& gain : gains) frames.push_back(photograph(light, gain, static_cast<std::int64_t>(frames.size())));
  return frames;
}

TEST(ExposureFollows, ThreeStopsEitherWayAndTheWhiteBalance) {
  const auto gains = wandering_gains(3);
  ASSERT_GT(0.6 * gains[12].g, 4) << "white is clipped by two stops, and so is the table";
  const auto frames = photographs(tag_light(), gains);
  expect_within(solved(frames), gains, 0.02);
  expect_within(causal(frames), gains, 0.02);
}

/// At 30 px, what the lens blurs between cells makes white 2.4 % too dark, in every frame alike: that is no wandering.
TEST(ExposureFollows, ASmallTag) {
  const auto gains = wandering_gains(1);
  const auto rows = solved(photographs(tag_light(30), gains));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(rows[i].exposure[c] / rows[0].exposure[c] / (gains[i][c] / gains[0][c]), 1, 0.01) << "frame " << i;
  EXPECT_NEAR(rows[0].exposure.g / 0.75, 1, 0.03);
}

TEST(ExposureFollows, FootageThatBeginsClippedIsMeasuredByWhatComesAfter) {
  auto gains = wandering_gains(2);
  std::rotate(gains.begin(), gains.begin() + 8, gains.end());  // +2 EV first
  const auto frames = photographs(tag_light(), gains);
  expect_within(solved(frames), gains, 0.02);
  EXPECT_NEAR(causal(frames)[0].exposure.g / (0.75 * gains[0].g), 1, 0.25) << "live, only the black cells are there: a guess";
}

TEST(ExposureFollows, AStepOfTwoStopsAtOnce) {
  std::vector<glm::dvec3> gains(8, glm::dvec3(0.5));
  std::fill(gains.begin() + 4, gains.end(), glm::dvec3(2.0));
  expect_within(causal(photographs(tag_light(), gains)), gains, 0.02);
}

TEST(ExposureFollows, TheSameClippedFrameAThousandTimesIsTheSameToTheLastBit) {
  const auto light = tag_light();
  // The pose is known, so that only the exposure could drift.
  const TrackRow seen = causal({photograph(light, glm::dvec3(1), 0)})[0];
  std::vector<TrackRow> poses(1001, seen);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].frame = static_cast<std::int64_t>(i);
    poses[i].has_exposure = false;
  }
  const auto track = make_recorded_track(poses, small_camera(), scene_of_tag_5());
  track->row(photograph(light, glm::dvec3(1), 0));
  const Frame clipped = photograph(light, glm::dvec3(2), 1);
  const auto again = [&](std::int64_t number) { return Frame(FramePtr(av_frame_clone(&clipped.picture())), number, 0); };
  const glm::dvec3 first = track->row(again(1)).exposure;
  EXPECT_NEAR(first.g, 1.5, 0.03);
  for (int i = 2; i <= 1000; ++i) ASSERT_EQ(track->row(again(i)).exposure, first) << i;
}

TEST(ExposureFollows, ABlackFrameAndAWhiteFrameAreHeldAndWarnedOf) {
  const auto light = tag_light();
  std::vector<Frame> frames =
      photographs(light, {glm::dvec3(1), glm::dvec3(1), glm::dvec3(1e-9), glm::dvec3(1e9), glm::dvec3(1)});
  ShotTrack track(small_camera(), scene_of_tag_5());
  for (const Frame& frame : frames) track.add(frame);
  const auto rows = track.solve();
  const auto live = causal(frames);
  for (const std::size_t i : {2, 3}) {
    EXPECT_NEAR(rows[i].exposure.g, 0.75, 0.015) << i;
    EXPECT_NEAR(rows[i].black.g, 0, 0.005) << i;
    EXPECT_EQ(live[i].exposure, live[1].exposure) << i;
  }
  EXPECT_EQ(track.warning(rows).has_value(), rows[2].found || rows[3].found);
}

TEST(ExposureFollows, ReadingThatFailsIsWarnedOfWhereverTheExposureIsFollowed) {
  const std::vector<Frame> frames = photographs(tag_light(), {glm::dvec3(1), glm::dvec3(1), glm::dvec3(1e-9), glm::dvec3(1)});
  for (const ExposureMode mode : {ExposureMode::match, ExposureMode::automatic, ExposureMode::fixed}) {
    SceneSettings scene = scene_of_tag_5();
    scene.exposure.mode = mode;
    ShotTrack recorded(small_camera(), scene);
    const auto live = make_tag_track(small_camera(), scene);
    for (const Frame& frame : frames) {
      recorded.add(frame);
      live->row(frame);
    }
    const auto rows = recorded.solve();
    ASSERT_TRUE(rows[2].found) << "the tag coasts over the black frame";
    EXPECT_EQ(recorded.warning(rows).has_value(), mode != ExposureMode::fixed) << name_of(mode);
    EXPECT_EQ(live->warning().has_value(), mode != ExposureMode::fixed) << name_of(mode);
  }
}

/// Light times `share` where `is_within` (of pixels) holds.
template <class Region>
std::vector<float> dimmed(std::vector<float> light, float share, const Region& is_within) {
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 200; ++x)
      if (is_within(x, y)) light[static_cast<std::size_t>(y * 200 + x)] *= share;
  return light;
}

TEST(ExposureFollows, ACastShadowThatMovesOverASixthOfTheTag) {
  const auto gains = wandering_gains(1);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const int edge = 74 + static_cast<int>(i % 6);  // the tag reaches from 70 to 130
    frames.push_back(
        photograph(dimmed(tag_light(), 0.5f, [edge](int x, int) { return x < edge; }), gains[i], static_cast<std::int64_t>(i)));
  }
  expect_within(solved(frames), gains, 0.02);
  expect_within(causal(frames), gains, 0.02);
}

TEST(ExposureFollows, AStainOnTheTag) {
  const auto stained = dimmed(tag_light(), 0.4f, [](int x, int y) { return std::hypot(x - 88, y - 88) < 8; });
  const auto gains = wandering_gains(1);
  const auto frames = photographs(stained, gains);
  expect_within(solved(frames), gains, 0.02);
  expect_within(causal(frames), gains, 0.02);
}

/// The light of a recording's frames, re-exposed: what H.264 did to them stays.
TEST(ExposureFollows, ARecordingWhoseExposureAndWhiteBalanceWander) {
  const std::string folder = std::string(CATCHLIGHT_SOURCE_DIR) + "/recordings/matte";
  const CameraModel camera = tracking::read_camera_file(folder + "/camera.yaml");
  SceneSettings matte;
  const auto gains = wandering_gains(1);
  ShotTrack plain(camera, matte), wandering(camera, matte);
  const auto live = make_tag_track(camera, matte);
  std::vector<TrackRow> live_rows;
  const auto source = MediaSource::open(folder + "/video.mp4");
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const auto frame = source->read();
    ASSERT_TRUE(frame);
    plain.add(*frame);
    const Frame drifted = reexposed(*frame, gains[i]);
    wandering.add(drifted);
    live_rows.push_back(live->row(drifted));
  }
  const auto before = plain.solve(), after = wandering.solve();
  for (std::size_t i = 0; i < gains.size(); ++i)
    for (int c = 0; c < 3; ++c)
      for (const TrackRow& row : {after[i], live_rows[i]})
        EXPECT_NEAR(row.exposure[c] / (before[i].exposure[c] * gains[i][c]), 1, 0.02) << "frame " << i << " channel " << c;
}

}  // namespace
}  // namespace catchlight::app
