// What is measured of the camera's lens and sensor, in rendered frames whose noise and blur are known.
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

// --- blur ---------------------------------------------------------------------------------------------------------------

/// A camera that swings to and fro over the tag.
std::vector<TrackRow> swinging(int frames) {
  std::vector<TrackRow> rows;
  for (int i = 0; i < frames; ++i) {
    TrackRow row = row_of(scene());
    row.frame = i;
    row.camera_from_tag =
        tracking::tag_pose(camera(), {160 + 20 * std::sin(0.4 * i), 120 + 12 * std::sin(0.27 * i)}, 0.3, {20, 15, 10});
    rows.push_back(row);
  }
  return rows;
}

/// The rows with the blur that focus and shutter make, and errors of that size.
std::vector<TrackRow> blurred(std::vector<TrackRow> rows, double focus_px2, double shutter, double error_px2) {
  std::vector<TrackRow> measured = rows;
  measure_blur(measured, camera(), 0.08);
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, error_px2);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Covariance2 m = motion_covariance(camera(), rows[i].camera_from_tag, measured[i].blur.motion, 0.08);
    const double s2 = shutter * shutter;
    rows[i].blur_px2 = {focus_px2 + s2 * m.xx + normal(random), s2 * m.xy + normal(random),
                        focus_px2 + s2 * m.yy + normal(random)};
  }
  return rows;
}

TEST(Blur, ShutterAndFocusAreTakenApart) {
  for (const double shutter : {0.25, 0.5, 1.0}) {
    std::vector<TrackRow> rows = blurred(swinging(60), 0.7, shutter, 0.05);
    measure_blur(rows, camera(), 0.08);
    for (const TrackRow& row : rows) {
      EXPECT_NEAR(row.blur.shutter / shutter, 1, 0.05);
      EXPECT_NEAR(row.blur.focus_px2 / 0.7, 1, 0.1);
    }
  }
}

TEST(Blur, AFastShutterShowsNone) {
  std::vector<TrackRow> rows = blurred(swinging(60), 0.7, 0, 0.05);
  measure_blur(rows, camera(), 0.08);
  EXPECT_EQ(rows[30].blur.shutter, 0);
  EXPECT_NEAR(rows[30].blur.focus_px2, 0.7, 0.07);
}

TEST(Blur, AFewWrongFramesDoNotDecide) {
  std::vector<TrackRow> rows = blurred(swinging(60), 0.7, 0.5, 0.03);
  for (const std::size_t i : {11, 23, 37}) rows[i].blur_px2 = {12, -5, 3};
  measure_blur(rows, camera(), 0.08);
  EXPECT_NEAR(rows[0].blur.shutter, 0.5, 0.05);
  EXPECT_NEAR(rows[23].blur.focus_px2, 0.7, 0.1);
}

/// Still rows, of which frame 30 is blurred by another 8 px^2 along a line; errors of 0.05 px^2.
std::vector<TrackRow> jerked(std::vector<TrackRow> rows, const glm::dvec2& direction) {
  rows = blurred(std::move(rows), 0.7, 0, 0.05);
  Covariance2& blur = rows[30].blur_px2;
  blur.xx += 8 * direction.x * direction.x, blur.xy += 8 * direction.x * direction.y, blur.yy += 8 * direction.y * direction.y;
  return rows;
}

std::vector<TrackRow> still(int frames) {
  std::vector<TrackRow> rows = swinging(frames);
  for (TrackRow& row : rows) row.camera_from_tag = rows[0].camera_from_tag;
  return rows;
}

/// What of the row's blur has a direction, as it is drawn.
Covariance2 drawn_motion(const TrackRow& row) {
  const render::TagMotion motion = camera_effects({}, row, noisy_frame(scene(), glm::dvec3(0), 0, 1)).motion;
  return motion_covariance(camera(), row.camera_from_tag, {motion.turn_rad, motion.shift_m}, 0.08);
}

/// One frame of sixty is jerked, and no shutter explains it.
TEST(Blur, AJerkedFrameIsDrawnWithItsOwnBlur) {
  const glm::dvec2 direction(0.8, 0.6);
  for (const std::vector<TrackRow>& before : {still(60), swinging(60)}) {
    std::vector<TrackRow> rows = jerked(before, direction);
    measure_blur(rows, camera(), 0.08);
    const Covariance2 drawn = drawn_motion(rows[30]);
    EXPECT_NEAR(drawn.xx, 8 * 0.64, 0.3);
    EXPECT_NEAR(drawn.xy, 8 * 0.48, 0.3);
    EXPECT_NEAR(drawn.yy, 8 * 0.36, 0.3);
    EXPECT_NEAR(rows[30].blur.focus_px2, 0.7, 0.2) << "across the line nothing has changed";
    EXPECT_NEAR(rows[29].blur.focus_px2, 0.7, 0.1);
    EXPECT_EQ(rows[29].blur.shake_rad, glm::dvec2(0.0));
  }
}

TEST(Blur, LiveFootageHasItsJerkInTheFrameItself) {
  std::vector<TrackRow> rows = jerked(still(60), {0, 1});
  BlurMeter meter(camera(), 0.08);
  for (TrackRow& row : rows) meter.add(row);
  EXPECT_NEAR(drawn_motion(rows[30]).yy, 8, 0.5);
  EXPECT_EQ(rows[31].blur.shake_rad, glm::dvec2(0.0));
}

/// What is measured of still frames has errors, which must not be drawn: edges would flicker.
TEST(Blur, StillFramesGetNoBlurOfTheirOwn) {
  std::vector<TrackRow> rows = blurred(still(1000), 0.7, 0, 0.1);
  measure_blur(rows, camera(), 0.08);
  EXPECT_LE(std::ranges::count_if(rows, [](const TrackRow& row) { return row.blur.shake_rad != glm::dvec2(0.0); }), 2);
}

/// Focus that is lost in one frame has no direction.
TEST(Blur, AFrameOutOfFocusIsDrawnOutOfFocus) {
  std::vector<TrackRow> rows = blurred(still(60), 0.7, 0, 0.02);
  rows[30].blur_px2.xx += 3, rows[30].blur_px2.yy += 3;
  measure_blur(rows, camera(), 0.08);
  EXPECT_NEAR(rows[30].blur.focus_px2, 3.7, 0.1);
  EXPECT_LT(drawn_motion(rows[30]).xx, 0.1);
  EXPECT_NEAR(rows[29].blur.focus_px2, 0.7, 0.05);
}

TEST(CameraEffects, AShutterThatIsSetByHandSaysAllThereIs) {
  TrackRow row;
  row.blur.shake_rad = {0.01, 0.02};
  const Frame frame = noisy_frame(scene(), glm::dvec3(0), 0, 1);
  SceneSettings::Lens lens;
  EXPECT_EQ(camera_effects(lens, row, frame).motion.turn_rad, glm::dvec3(0.01, 0.02, 0));
  lens.shutter = 0.25;
  EXPECT_EQ(camera_effects(lens, row, frame).motion.turn_rad, glm::dvec3(0));
  lens = {}, lens.motion_blur = Switch::off;
  EXPECT_EQ(camera_effects(lens, row, frame).motion.turn_rad, glm::dvec3(0));
}

TEST(Blur, LiveRowsKnowThePastAlone) {
  const std::vector<TrackRow> rows = blurred(swinging(60), 0.7, 0.5, 0.02);
  BlurMeter all(camera(), 0.08), first_half(camera(), 0.08);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    TrackRow a = rows[i], b = rows[i];
    all.add(a);
    if (i >= 40) continue;
    first_half.add(b);
    EXPECT_EQ(a.blur.shutter, b.blur.shutter);
    EXPECT_EQ(a.blur.focus_px2, b.blur.focus_px2);
  }
  TrackRow last = rows.back();
  last.frame = 60;
  all.add(last);
  EXPECT_NEAR(last.blur.shutter, 0.5, 0.1);
}

/// From pictures: frames averaged over the shutter, tracked, and taken apart.
TEST(Blur, ARenderedShutterIsMeasuredWithinATenth) {
  constexpr double kShutter = 0.6;
  SceneSettings settings;
  settings.tag.id = 5;
  ShotTrack track(camera(), settings);
  for (int i = 0; i < 16; ++i) {
    constexpr int kSteps = 9;
    std::vector<float> light(320 * 240, 0.0f);
    for (int k = 0; k < kSteps; ++k) {
      const double t = i + kShutter * ((k + 0.5) / kSteps - 0.5);
      SyntheticScene moving = scene();
      moving.tags[0].camera_from_tag =
          tracking::tag_pose(camera(), {160 + 30 * std::sin(0.3 * t), 120 + 8 * std::sin(0.2 * t)}, 0.5, {20, 15, 10});
      const std::vector<float> one = tracking::render(moving).linear;
      for (std::size_t p = 0; p < light.size(); ++p) light[p] += one[p] / kSteps;
    }
    const std::vector<std::uint8_t> codes = tracking::expose(light, 0.7, static_cast<unsigned>(i));
    FramePtr picture = noise_frame(AV_PIX_FMT_RGB24, 320, 240, 1);
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 320; ++x)
        std::fill_n(picture->data[0] + y * picture->linesize[0] + 3 * x, 3, codes[static_cast<std::size_t>(y * 320 + x)]);
    track.add({std::shared_ptr<const AVFrame>(std::move(picture)), i, i / 30.0});
  }
  const std::vector<TrackRow> rows = track.solve();
  EXPECT_NEAR(rows[8].blur.shutter / kShutter, 1, 0.1);
  // The lens's Gaussian of 0.6 px and the pixel's own square.
  EXPECT_NEAR(rows[8].blur.focus_px2 / (0.36 + 1.0 / 12), 1, 0.1);
}

TEST(CameraEffects, EverythingCanBeSwitchedOffAlone) {
  TrackRow row;
  row.noise = {glm::dvec3(3e-4), glm::dvec3(0), glm::dvec3(0)};
  row.blur = {{{0.01, 0, 0}, {0.02, 0, 0}}, 0.5, 1.0};
  const Frame frame = noisy_frame(scene(), glm::dvec3(0), 0, 1);
  CameraModel camera;
  camera.vignetting = {-0.2, 0, 0};
  camera.distortion[0] = -0.3;
  const render::CameraEffects all = camera_effects({}, row, frame);
  EXPECT_TRUE(all.noise.enabled);
  EXPECT_NEAR(all.defocus_px2, 1 - 1.0 / 12, 1e-12);
  EXPECT_EQ(all.motion.shift_m.x, 0.01);
  EXPECT_EQ(SceneSettings::Lens{}.as_drawn(camera).vignetting, camera.vignetting);
  EXPECT_EQ(SceneSettings::Lens{}.as_drawn(camera).distortion, camera.distortion);
  SceneSettings::Lens lens;
  lens.noise = Switch::off;
  EXPECT_FALSE(camera_effects(lens, row, frame).noise.enabled);
  EXPECT_GT(camera_effects(lens, row, frame).defocus_px2, 0);
  lens = {}, lens.defocus = Switch::off;
  EXPECT_EQ(camera_effects(lens, row, frame).defocus_px2, 0);
  lens = {}, lens.motion_blur = Switch::off;
  EXPECT_EQ(camera_effects(lens, row, frame).motion.shift_m, glm::dvec3(0));
  lens = {}, lens.vignetting = Switch::off;
  EXPECT_EQ(lens.as_drawn(camera).vignetting, glm::dvec3(0));
  EXPECT_TRUE(lens.as_drawn(camera).has_distortion());
  lens = {}, lens.distortion = Switch::off;
  EXPECT_FALSE(lens.as_drawn(camera).has_distortion());
  lens = {}, lens.shutter = 0.25;
  EXPECT_EQ(camera_effects(lens, row, frame).motion.shift_m.x, 0.005);
}

TEST(CameraEffects, ThePlanNeitherAsksForWhatIsOnNorBlamesTheCellsOfATagThatIsNotThere) {
  using ::testing::HasSubstr;
  const Frame frame = noisy_frame(scene(), glm::dvec3(0), 0, 1);
  TrackRow found;
  found.found = true;
  SceneSettings settings;
  const auto reason = [&](const TrackRow& row, std::size_t entry, bool has_track_file = false) {
    return lens_plan(settings, {row}, frame, {}, has_track_file)[entry].reason;
  };
  for (const std::size_t entry : {0, 1, 2}) {
    EXPECT_EQ(reason(TrackRow{}, entry), "not measured: the tag was not found");
    EXPECT_EQ(reason(found, entry, true), "not measured: the track file does not say");
  }
  EXPECT_EQ(reason(found, 0), "not measured: the tag's cells are too small");
  EXPECT_THAT(reason(found, 1), ::testing::Not(HasSubstr("direct"))) << "it is on";
  settings.tag.refinement = tracking::Refinement::corners;
  EXPECT_THAT(reason(found, 1), HasSubstr("needs tag.refinement direct"));
}

TEST(CameraEffects, NothingMeasuredIsNothingAddedAndThePlanSaysWhy) {
  const Frame frame = noisy_frame(scene(), glm::dvec3(0), 0, 1);
  const render::CameraEffects none = camera_effects({}, TrackRow{}, frame);
  EXPECT_FALSE(none.noise.enabled);
  EXPECT_EQ(none.defocus_px2, 0);
  EXPECT_EQ(none.motion.shift_m, glm::dvec3(0));
  const std::vector<PlanEntry> plan = lens_plan({}, {TrackRow{}}, frame, {});
  ASSERT_EQ(plan.size(), 5u);
  for (const PlanEntry& entry : plan) {
    EXPECT_EQ(entry.value, "off") << entry.choice;
    EXPECT_THAT(entry.reason, ::testing::Not(::testing::IsEmpty()));
  }
}

}  // namespace
}  // namespace catchlight::app
