// Which track files a shot takes.
#include "app/session/track_check.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::message_of;

const CameraModel kCamera{640, 480, 600, 600, 319.5, 239.5, {-0.1}};
const PrintedTag kTag{"tag36h11", 5, 0.08};

/// Rows of the frames `first` to `last`, at 24 Hz, as a track file of kCamera and kTag has them.
tracking::TrackFile file_of(std::int64_t first, std::int64_t last) {
  tracking::TrackFile file{{}, tracking::TrackSubject{kCamera, kTag}, true};
  for (std::int64_t i = first; i <= last; ++i)
    file.rows.emplace_back().frame = i, file.rows.back().time_s = static_cast<double>(i) / 24;
  return file;
}

SourceInfo footage_of_36_frames() {
  SourceInfo info;
  info.frame_count = 36;
  info.frame_rate = 24;
  return info;
}

struct Checked {
  std::vector<std::string> warnings;
  TrackCheck check;

  Checked(const tracking::TrackFile& file, const CameraModel& camera = kCamera, const PrintedTag& tag = kTag)
      : check("t.csv", file, camera, tag, footage_of_36_frames(),
              [this](const std::string& warning) { warnings.push_back(warning); }) {}
};

std::string refusal(const CameraModel& camera, const PrintedTag& tag = kTag) {
  return message_of<Error>([&] { Checked(file_of(0, 35), camera, tag); });
}

TEST(TrackCheck, TheShotsOwnTrackIsTaken) {
  Checked checked(file_of(0, 35));
  for (int i = 0; i < 36; ++i) checked.check.see(i, i / 24.0);
  EXPECT_THAT(checked.warnings, IsEmpty());
  EXPECT_EQ(checked.check.missing_rows(), "");
}

TEST(TrackCheck, AnotherSizeCameraOrTagIsRefusedInItsOwnWords) {
  CameraModel camera = kCamera;
  camera.width_px = 1280;
  EXPECT_THAT(refusal(camera), HasSubstr("t.csv: is the track of pictures of 640x480, and the footage is 1280x480"));
  camera = kCamera, camera.fx_px = camera.fy_px = 720;
  EXPECT_THAT(refusal(camera), HasSubstr("(focal length 600.0 px, here 720.0 px)"));
  camera = kCamera, camera.distortion = {};
  EXPECT_THAT(refusal(camera), HasSubstr("another camera"));
  EXPECT_THAT(refusal(kCamera, {"tag36h11", 6, 0.08}), HasSubstr("tag36h11 #5 of 80 mm, and the scene's tag is tag36h11 #6 of"));
  EXPECT_THAT(refusal(kCamera, {"tag36h11", 5, 0.14}), HasSubstr("80 mm, and the scene's tag is tag36h11 #5 of 140 mm"));
}

/// A calibration that is done again is never the same to the last digit.
TEST(TrackCheck, ACameraThatSeesEverythingWithinAPixelIsTheSame) {
  CameraModel camera = kCamera;
  camera.fx_px = camera.fy_px = 601, camera.cx_px += 0.2;
  EXPECT_LT(distance_px(kCamera, camera), 1);
  EXPECT_THAT(Checked(file_of(0, 35), camera).warnings, IsEmpty());
}

TEST(TrackCheck, BarePosesBelongToEveryShot) {
  tracking::TrackFile bare = file_of(0, 35);
  bare.subject.reset(), bare.has_times = false;
  for (TrackRow& row : bare.rows) row.time_s = 0;
  Checked checked(bare, {1280, 720, 900, 900, 640, 360, {}}, {"tag25h9", 1, 0.5});
  checked.check.see(7, 7 / 24.0);
  EXPECT_THAT(checked.warnings, IsEmpty());
}

TEST(TrackCheck, RowsBesideTheFootageAndOtherTimesAreWarnedOfOnce) {
  Checked longer(file_of(0, 92));
  EXPECT_THAT(longer.warnings, ElementsAre(HasSubstr("has rows of the frames 0 to 92, and the footage has 0 to 35")));
  Checked slower(file_of(0, 35));
  for (int i = 0; i < 36; ++i) slower.check.see(i, i / 12.0);
  EXPECT_THAT(slower.warnings, ElementsAre(HasSubstr("frame 1 is at 0.042 s in it, and at 0.083 s in the footage")));
}

TEST(TrackCheck, MissingRowsAreCounted) {
  Checked checked(file_of(10, 19));
  for (int i = 8; i < 24; ++i) checked.check.see(i, i / 24.0);
  EXPECT_EQ(checked.check.missing_rows(), "; t.csv has no row for 6 of them, the first of which is frame 8");
}

}  // namespace
}  // namespace catchlight::app
