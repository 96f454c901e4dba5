// Path-traced plates with known poses, where the checkout has them beside it.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/camera/camera_file.hpp"
#include "tracking/observation.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::tracking {
namespace {

/// Rows of frame, r00..r22, tx, ty, tz after a line of names.
std::map<int, RigidTransform> read_poses(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::map<int, RigidTransform> poses;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream values(line);
    int frame = 0;
    values >> frame;
    RigidTransform& pose = poses[frame];
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) values >> pose.rotation[column][row];
    for (int row = 0; row < 3; ++row) values >> pose.translation_m[row];
  }
  return poses;
}

struct Sequence {
  const char* name;
  int tag_id;
};

class GroundTruth : public ::testing::TestWithParam<Sequence> {};

TEST_P(GroundTruth, CornersOfThePoseAreWithinAFiftiethOfAPixel) {
  const auto folder = std::filesystem::path(CATCHLIGHT_SOURCE_DIR).parent_path() / "shared/groundtruth" / GetParam().name;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const CameraModel camera = read_camera_file((folder / "camera.yaml").string());
  SyntheticTag tag;
  tag.target.id = GetParam().tag_id;
  Tracker tracker(camera, tag.target);
  double squares = 0, bias_px = 0, worst_turn_deg = 0;
  const auto poses = read_poses(folder / "poses.csv");
  ASSERT_FALSE(poses.empty());
  int count = 0;
  for (const auto& [frame, camera_from_tag] : poses) {
    if (frame % 3 != 0) continue;
    ++count;
    char name[32];
    std::snprintf(name, sizeof name, "plate/%04d.png", frame);
    const cv::Mat codes = cv::imread((folder / name).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(codes.empty()) << name;
    const LumaView luma{codes.data, codes.cols, codes.rows, static_cast<int>(codes.step)};
    const TagObservation seen = tracker.track(luma, frame / 24.0);
    ASSERT_EQ(seen.state, TrackState::tracking) << name;
    tag.camera_from_tag = camera_from_tag;
    const auto truth = true_corners_px(camera, tag);
    tag.camera_from_tag = seen.camera_from_tag;
    const auto found = true_corners_px(camera, tag);
    squares += std::pow(rms_distance(found, truth), 2);
    bias_px += outward_bias_px(found, truth);
    worst_turn_deg = std::max(worst_turn_deg, turn_between_deg(seen.camera_from_tag, camera_from_tag));
  }
  const double rms_px = std::sqrt(squares / count);
  std::cout << GetParam().name << ": corners of the pose rms " << rms_px << " px, outward bias " << bias_px / count
            << " px, largest turn " << worst_turn_deg << " deg\n";
  EXPECT_LT(rms_px, 0.02);
  EXPECT_NEAR(bias_px / count, 0, 0.003);
  EXPECT_LT(worst_turn_deg, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Sequences, GroundTruth,
                         ::testing::Values(Sequence{"matte", 0}, Sequence{"gloss", 101}, Sequence{"mirror", 7}),
                         [](const auto& sequence) { return sequence.param.name; });

}  // namespace
}  // namespace catchlight::tracking
