// What EXR layers say of the shot besides light: attributes, and layers for Nuke and Blender.
#include <gmock/gmock.h>

#include <cmath>

#include "catchlight/projection.hpp"
#include "tests/app/commands/overlay_command.hpp"
#include "tests/support/layers_file.hpp"
#include "tracking/camera/camera_file.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::tests {
namespace {

using ::testing::HasSubstr;

class ExrShot : public OverlayCommand {
 protected:
  /// Three frames that begin at ten hours.
  void SetUp() override {
    copy_ = copied_recording(3);
    run_shell("ffmpeg -v error -nostdin -i " + copy_ + "/video.mp4 -c copy -timecode 10:00:00:23 " + copy_ + "/clip.mov");
    std::filesystem::rename(copy_ + "/clip.mov", copy_ + "/video.mov");
    std::filesystem::remove(copy_ + "/video.mp4");
  }

  void write_layers(std::vector<std::string> more) {
    more.insert(more.end(), {"--track", recording() + "/poses.csv"});
    const CommandResult result = overlay(copy_, folder_.path("l.%d.exr"), more);
    ASSERT_EQ(result.exit_code, 0) << result.error;
  }

  std::string copy_;
};

TEST_F(ExrShot, AttributesSayRateTimecodeCameraAndSoftware) {
  write_layers({});
  const render::ExrAttributes attributes = read_attributes(folder_.path("l.1.exr"));
  EXPECT_NEAR(attributes.frames_per_second, 24, 1e-6);
  EXPECT_EQ(attributes.time_code, "10:00:01:00") << "the frame after 10:00:00:23";
  EXPECT_THAT(attributes.software, HasSubstr("Catchlight"));
  const CameraModel camera = tracking::read_camera_file(copy_ + "/camera.yaml");
  const TrackRow row = tracking::read_track_file(recording() + "/poses.csv").rows.at(1);
  // A point above the tag's centre; the tag lies on a table, so it is up in the world.
  const glm::dvec3 seen_m = row.camera_from_tag * glm::dvec3(0, 0, 0.05);
  const glm::dvec4 world_m(0, 0.05, 0, 1);
  const glm::dvec4 in_camera_m = attributes.camera_from_world.value() * world_m;
  EXPECT_NEAR(in_camera_m.x, seen_m.x, 1e-5);
  EXPECT_NEAR(in_camera_m.y, -seen_m.y, 1e-5);
  EXPECT_NEAR(in_camera_m.z, -seen_m.z, 1e-5);
  const glm::dvec4 clip = attributes.clip_from_world.value() * world_m;
  const glm::dvec2 px = project_ideal_px(camera, seen_m).value();
  EXPECT_NEAR((clip.x / clip.w + 1) / 2 * camera.width_px - 0.5, px.x, 1e-2);
  EXPECT_NEAR((1 - clip.y / clip.w) / 2 * camera.height_px - 0.5, px.y, 1e-2);
}

TEST_F(ExrShot, NukeGetsOffsetsToTheNeighboursThatAreThere) {
  write_layers({"--layers-for", "nuke"});
  const auto greatest = [&](int frame, const std::string& layer) {
    const Image motion = read_channels(folder_.path("l." + std::to_string(frame) + ".exr"), {layer + ".u", layer + ".v"});
    double most = 0;
    for (const float value : motion.data) most = std::max(most, std::abs(static_cast<double>(value)));
    return most;
  };
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(greatest(frame, "backward") > 0, frame > 0) << frame;
    EXPECT_EQ(greatest(frame, "forward") > 0, frame < 2) << frame;
    EXPECT_LT(greatest(frame, "forward"), 30) << "pixels from frame to frame";
  }
}

/// Every surface that is seen looks towards the camera: Nuke's z is positive there.
TEST_F(ExrShot, NormalsAreInTheAxesAskedFor) {
  write_layers({"--layers-for", "nuke", "--frames", "1"});
  const Image normals = read_channels(folder_.path("l.1.exr"), {"N.X", "N.Y", "N.Z"});
  double sum_z = 0;
  for (std::size_t i = 2; i < normals.data.size(); i += 3) sum_z += normals.data[i];
  EXPECT_GT(sum_z, 0);
  write_layers({"--layers-for", "blender", "--frames", "1", "-y"});
  EXPECT_NO_THROW(read_channels(folder_.path("l.1.exr"), {"Vector.X", "Vector.Y", "Vector.Z", "Vector.W"}));
}

TEST_F(ExrShot, OnlyLayersAreForOtherPrograms) {
  const std::string video = folder_.path("out.mp4");
  expect_refused(overlay(copy_, video, {"--layers-for", "nuke"}), video, {"--layers-for: " + video + " is no layers"}, 2);
}

}  // namespace
}  // namespace catchlight::tests
