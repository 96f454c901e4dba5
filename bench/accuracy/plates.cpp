#include <algorithm>
#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "bench/accuracy/experiments.hpp"
#include "bench/accuracy/score.hpp"
#include "catchlight/error.hpp"
#include "tracking/camera/camera_file.hpp"

namespace catchlight::tracking {
namespace {

/// A folder of `camera.yaml`, `poses.csv` (frame, r00..r22, tx, ty, tz after a line of names) and `plate/%04d.png`.
Clip read_plates(const std::filesystem::path& folder, int tag_id) {
  Clip clip{read_camera_file((folder / "camera.yaml").string()), {}, {}};
  clip.target.id = tag_id;
  std::ifstream poses(folder / "poses.csv");
  std::string line;
  std::getline(poses, line);
  while (std::getline(poses, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream values(line);
    int number = 0;
    values >> number;
    ClipFrame frame;
    frame.time_s = number / 24.0;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) values >> frame.camera_from_tag.rotation[column][row];
    for (int row = 0; row < 3; ++row) values >> frame.camera_from_tag.translation_m[row];
    char name[32];
    std::snprintf(name, sizeof name, "plate/%04d.png", number);
    const cv::Mat codes = cv::imread((folder / name).string(), cv::IMREAD_GRAYSCALE);
    if (codes.empty()) throw Error((folder / name).string() + " is missing or no picture");
    frame.picture = {codes.cols, codes.rows, {}, {codes.begin<std::uint8_t>(), codes.end<std::uint8_t>()}};
    clip.frames.push_back(std::move(frame));
  }
  return clip;
}

}  // namespace

void measure_plates(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) {
    std::printf("\nPath-traced plates: left out, %s is not there\n", folder.c_str());
    return;
  }
  std::puts("\nPath-traced plates, 36 frames each: RMS per axis | RMS of the distance | outward bias (px) | found");
  const std::pair<const char*, int> sequences[] = {{"matte", 0}, {"gloss", 101}, {"mirror", 7}};
  for (const auto& [name, tag_id] : sequences) {
    const Clip clip = read_plates(folder / name, tag_id);
    LadderRow row;
    for (const auto& measure : {peers, rungs, followed})
      for (const MethodResult& result : measure(clip)) add_result(clip, result, row);
    for (const auto& [method, score] : row.methods)
      std::printf("%8s %16s %8.4f %8.4f %8.4f %5.0f%%\n", name, method.c_str(), score.rms_per_axis_px(), score.rms_2d_px(),
                  score.outward_bias_px(), score.found_percent());
  }
  std::fflush(stdout);
}

}  // namespace catchlight::tracking
