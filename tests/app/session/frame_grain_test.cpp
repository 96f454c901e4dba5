// The grain that is measured, in rendered frames whose noise is known.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "app/session/frame_track.hpp"
#include "app/session/frame_view.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tests/support/noisy_tag.hpp"
#include "tracking/camera/blur.hpp"
#include "tracking/camera/grain.hpp"

namespace catchlight::app {
namespace {

using noisy_tag::camera;
using noisy_tag::noisy_frame;
using noisy_tag::row_of;
using noisy_tag::scene;
using noisy_tag::target;
using testing::noise_frame;
using tracking::BlurMeter;
using tracking::GrainMeter;
using tracking::measure_blur;
using tracking::motion_covariance;
using tracking::SyntheticScene;

NoiseModel measured(const glm::dvec3& slope, double floor, int frames = 4) {
  GrainMeter meter(camera(), target());
  for (int i = 1; i <= frames; ++i) meter.add(noisy_frame(scene(), slope, floor, static_cast<unsigned>(i)), row_of(scene()));
  return meter.model();
}

TEST(GrainMeter, FindsTheVarianceOfEachChannelWithinATwentieth) {
  const glm::dvec3 slope(2e-4, 3e-4, 5e-4);
  const NoiseModel model = measured(slope, 2e-6);
  for (int c = 0; c < 3; ++c)
    for (const double light : {0.03, 0.2, 0.6})
      EXPECT_NEAR((model.slope[c] * light + model.floor[c]) / (slope[c] * light + 2e-6), 1, 0.05) << c << " at " << light;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(model.correlation[i], 0, 0.05);
}

TEST(GrainMeter, RoundingAloneIsNoNoise) {
  const NoiseModel model = measured(glm::dvec3(0), 0, 2);
  EXPECT_LT(noise_codes(model, PlateColor{}, 0.5), 0.25);
  const SceneSettings::Lens lens;
  TrackRow row;
  row.noise = model;
  const Frame frame = noisy_frame(scene(), glm::dvec3(0), 0, 1);
  EXPECT_FALSE(camera_effects(lens, row, frame).noise.enabled);
  row.noise.slope = glm::dvec3(3e-4);
  EXPECT_TRUE(camera_effects(lens, row, frame).noise.enabled);
}

TEST(GrainMeter, SmallTagsSayNothing) {
  SyntheticScene far = scene();
  far.tags[0].camera_from_tag = tracking::tag_pose(camera(), {160, 120}, 2.4, {0, 0, 0});
  GrainMeter meter(camera(), target());
  meter.add(noisy_frame(far, glm::dvec3(3e-4), 0, 1), row_of(far));
  EXPECT_FALSE(meter.model().is_measured());
}

TEST(GrainMeter, AStainOnACellIsLeftOut) {
  const glm::dvec3 slope(3e-4);
  Frame frame = noisy_frame(scene(), slope, 0, 1);
  const auto& picture = const_cast<AVFrame&>(frame.picture());
  for (int y = 60; y < 85; ++y)  // a striped sticker over a corner of the print
    for (int x = 100; x < 130; ++x)
      if (y % 2) std::fill_n(picture.data[0] + y * picture.linesize[0] + 3 * x, 3, std::uint8_t{120});
  GrainMeter meter(camera(), target());
  meter.add(frame, row_of(scene()));
  EXPECT_NEAR(meter.model().slope.g / 3e-4, 1, 0.1);
}

/// Toner leaves streaks, which no grain has.
TEST(GrainMeter, StreaksOfThePrintAreNoGrain) {
  const glm::dvec3 slope(1e-4);
  const auto seen = [&](double streak_codes) {
    GrainMeter meter(camera(), target());
    for (unsigned seed = 1; seed <= 4; ++seed) {
      Frame frame = noisy_frame(scene(), slope, 2e-6, seed);
      const auto& picture = const_cast<AVFrame&>(frame.picture());
      for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 3 * 320; ++x) {
          std::uint8_t& code = picture.data[0][y * picture.linesize[0] + x];
          if (code < 80) code = static_cast<std::uint8_t>(std::lround(code + streak_codes * std::sin(x / 3 * 2 * M_PI / 9)));
        }
      meter.add(frame, row_of(scene()));
    }
    return meter.model();
  };
  const NoiseModel plain = seen(0), streaked = seen(10);
  const auto deviation = [](const NoiseModel& model, double light) { return std::sqrt(model.slope.g * light + model.floor.g); };
  EXPECT_NEAR(deviation(streaked, 0.6) / deviation(plain, 0.6), 1, 0.1);
  EXPECT_LT(deviation(streaked, 0.03) / deviation(plain, 0.03), std::sqrt(3) * 1.05) << "3.7 without";
}

/// Luma of 4:2:0 footage is noisy and its chroma, after the codec, is not.
TEST(GrainMeter, LumaNoiseAloneIsTheSameInAllChannels) {
  const Frame rgb = noisy_frame(scene(), glm::dvec3(3e-4), 0, 1);
  FramePtr picture = noise_frame(AV_PIX_FMT_YUV420P, 320, 240, 1);
  picture->color_range = AVCOL_RANGE_JPEG;
  picture->colorspace = AVCOL_SPC_BT709;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      picture->data[0][y * picture->linesize[0] + x] = rgb.picture().data[0][y * rgb.picture().linesize[0] + 3 * x];
  for (int plane : {1, 2})
    for (int y = 0; y < 120; ++y) std::fill_n(picture->data[plane] + y * picture->linesize[plane], 160, std::uint8_t{128});
  GrainMeter meter(camera(), target());
  meter.add(Frame(std::shared_ptr<const AVFrame>(std::move(picture)), 0, 0), row_of(scene()));
  const NoiseModel model = meter.model();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(model.slope[c] / 3e-4, 1, 0.1) << c;
  for (int i = 0; i < 3; ++i) EXPECT_GT(model.correlation[i], 0.97);
  const glm::dmat3 mix = noise_mix(model);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mix[2][c], 1, 0.02) << "all of it is the pixel's own";
}

TEST(NoiseMix, HasTheCorrelationsItIsMadeFrom) {
  for (const glm::dvec3 correlation : {glm::dvec3(0), glm::dvec3(0.6, 0.4, 0.5), glm::dvec3(-0.2, 0.1, 0.3), glm::dvec3(1)}) {
    const NoiseModel noise{{2e-4, 3e-4, 1e-4}, {1e-6, 0, 2e-6}, correlation};
    const glm::dmat3 mix = noise_mix(noise), together = mix * glm::transpose(mix);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(together[c][c], 1, 1e-9);
    if (correlation.x == 1) continue;  // one noise of three strengths is not luma alone, and its colour would be the pixel's
    EXPECT_NEAR(together[0][1], correlation.x, 0.01);
    EXPECT_NEAR(together[0][2], correlation.y, 0.01);
    EXPECT_NEAR(together[1][2], correlation.z, 0.01);
  }
}

}  // namespace
}  // namespace catchlight::app
