// Makes the pictures and poses of recordings/frontal: a small, nearly frontal tag that leaves the picture and comes back.
// scripts/make-frontal-recording encodes them; nothing here is random from run to run.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "tests/support/synthetic_tag.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kFrames = 120;
constexpr double kFramesPerSecond = 24;

/// A hand that holds nearly still on the tag, drifts off to the right until it is out of the picture, and comes back.
RigidTransform camera_from_tag(const CameraModel& camera, int frame) {
  const double t = frame / kFramesPerSecond;
  const auto sway = [&](double size, double hertz, double phase) { return size * std::sin(2 * M_PI * hertz * t + phase); };
  const double away = std::exp(-std::pow((t - 2.9) / 0.55, 2));  // 1 where it is farthest
  const glm::dvec2 center_px(360 + 380 * away + sway(14, 0.31, 1) + sway(2.5, 1.7, 0), 250 + sway(20, 0.23, 2) + sway(2, 2.1, 3));
  const double side_px = 42 + 9 * std::sin(2 * M_PI * 0.17 * t);
  return tag_pose(camera, center_px, camera.fx_px * 0.08 / side_px,
                  {sway(7, 0.27, 0.4) + sway(0.8, 1.9, 0), sway(8, 0.21, 2.2) + sway(0.8, 2.3, 1), 4 + sway(5, 0.19, 0)});
}

/// Wood-like stripes where there is neither print nor paper, so that the picture is not empty.
void add_table(SyntheticFrame& frame, double background_linear, const glm::dvec2& shift_px) {
  for (int y = 0; y < frame.height_px; ++y)
    for (int x = 0; x < frame.width_px; ++x) {
      float& light = frame.linear[static_cast<std::size_t>(y * frame.width_px + x)];
      if (light != static_cast<float>(background_linear)) continue;
      const double u = x - shift_px.x, v = y - shift_px.y;
      const double grain = std::sin(0.09 * v + 3 * std::sin(0.011 * u) + 1.4 * std::sin(0.031 * v));
      const bool seam = std::abs(std::fmod(std::fmod(v, 96) + 96, 96) - 48) < 1.2;
      light *= static_cast<float>(seam ? 0.35 : 1 + 0.25 * grain);
    }
}

void write_pose(std::ofstream& csv, int frame, const RigidTransform& pose) {
  csv << frame;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) csv << ',' << pose.rotation[column][row];
  for (int row = 0; row < 3; ++row) csv << ',' << pose.translation_m[row];
  csv << '\n';
}

int make(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "plate");
  std::ofstream csv(folder / "poses.csv");
  csv.precision(17);
  csv << "frame,r00,r01,r02,r10,r11,r12,r20,r21,r22,tx,ty,tz\n";
  SyntheticScene scene;
  scene.camera = {640, 480, 900, 900, 319.5, 239.5, {}};
  scene.tags.resize(1);
  scene.tags[0].target.id = 42;
  scene.blur_px = 0.7;
  scene.paper_margin_cells = 1.5;
  for (int frame = 0; frame < kFrames; ++frame) {
    scene.tags[0].camera_from_tag = camera_from_tag(scene.camera, frame);
    const auto corners_px = true_corners_px(scene.camera, scene.tags[0]);
    SyntheticFrame image = render(scene);
    add_table(image, scene.background_linear, corners_px[0]);
    image.codes = expose(image.linear, 2.5, static_cast<unsigned>(frame + 1));
    char name[32];
    std::snprintf(name, sizeof name, "plate/%04d.png", frame);
    const cv::Mat gray(image.height_px, image.width_px, CV_8UC1, image.codes.data());
    if (!cv::imwrite((folder / name).string(), gray)) return 1;
    write_pose(csv, frame, scene.tags[0].camera_from_tag);
  }
  return csv ? 0 : 1;
}

}  // namespace
}  // namespace catchlight::tracking

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_frontal_recording FOLDER\n", stderr);
    return 2;
  }
  return catchlight::tracking::make(argv[1]);
}
