// What a tracked frame costs beside detection alone, at 1280x720 with one thread. Compare the rows of one run; the machine's
// speed cancels there. Add --benchmark_filter=cluttered or =flat for one kind of footage.
#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>
#ifdef CATCHLIGHT_WITH_ARUCO
#include <opencv2/aruco.hpp>
#endif

#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/observation.hpp"
#include "tracking/pose/planar_pose.hpp"
#include "tracking/refinement/corner_refinement.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kFrames = 12;
constexpr double kNoiseCodes = 3;

/// A tag of 120 px that moves by a pixel a frame, forth and back, among noise. Flat noisy ground is the detector's worst case.
struct Footage {
  CameraModel camera{1280, 720, 1200, 1200, 639.5, 359.5, {}};
  std::vector<SyntheticFrame> frames;

  const SyntheticFrame& at(int i) const {
    const int phase = i % (2 * kFrames - 2);
    return frames[static_cast<std::size_t>(std::min(phase, 2 * kFrames - 2 - phase))];
  }
};

/// Upright boxes of all sizes and shades around the tag.
void clutter(cv::Mat1f& linear, const cv::Rect& tag) {
  const cv::Mat1f kept = linear(tag).clone();
  cv::RNG random(1);
  for (int i = 0; i < 600; ++i) {
    const cv::Point corner(random.uniform(0, linear.cols), random.uniform(0, linear.rows));
    const cv::Size size(random.uniform(5, 120), random.uniform(5, 120));
    cv::rectangle(linear, {corner, size}, cv::Scalar(random.uniform(0.02, 0.7)), cv::FILLED);
  }
  cv::GaussianBlur(linear, linear, {}, 0.7);
  kept.copyTo(linear(tag));
}

Footage make_footage(bool cluttered) {
  Footage footage;
  for (int i = 0; i < kFrames; ++i) {
    SyntheticScene scene;
    scene.camera = footage.camera;
    scene.tags.resize(1);
    scene.tags[0].camera_from_tag = tag_pose(scene.camera, {600.0 + i, 330.0 + 0.5 * i}, 0.8, {25 + 0.3 * i, 10, 20});
    SyntheticFrame frame = render(scene);
    cv::Mat1f linear(frame.height_px, frame.width_px, frame.linear.data());
    if (cluttered) clutter(linear, {500, 230, 220, 220});
    frame.codes = expose(frame.linear, kNoiseCodes, static_cast<unsigned>(i) + 1);
    footage.frames.push_back(std::move(frame));
  }
  return footage;
}

const Footage& footage(bool cluttered) {
  static const Footage kinds[] = {make_footage(false), make_footage(true)};
  return kinds[cluttered ? 1 : 0];
}

void detect(benchmark::State& state, bool cluttered, double decimate) {
  Detector detector("tag36h11", {.refinement = Refinement::none});
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(footage(cluttered).at(i++).luma(), decimate));
}

#ifdef CATCHLIGHT_WITH_ARUCO
void aruco(benchmark::State& state, bool cluttered, cv::aruco::CornerRefineMethod refinement) {
  cv::setNumThreads(1);
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11);
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = refinement;
  int i = 0;
  for (auto _ : state) {
    const SyntheticFrame& frame = footage(cluttered).at(i++);
    const cv::Mat codes(frame.height_px, frame.width_px, CV_8U, const_cast<std::uint8_t*>(frame.codes.data()));
    std::vector<std::vector<cv::Point2f>> squares;
    std::vector<int> ids;
    cv::aruco::detectMarkers(codes, dictionary, squares, ids, parameters);
    benchmark::DoNotOptimize(squares);
  }
}
#endif

/// Frames `frame_s` apart: longer than a lost tag's pose is predicted, each is the first. `missed` counts frames without the tag.
void track(benchmark::State& state, bool cluttered, Refinement refinement, double frame_s) {
  Tracker tracker(footage(cluttered).camera, {}, {.refinement = refinement});
  int i = 0, missed = 0;
  for (auto _ : state) {
    const TagObservation seen = tracker.track(footage(cluttered).at(i).luma(), i * frame_s);
    missed += seen.state != TrackState::tracking;
    ++i;
  }
  state.counters["missed"] = missed;
}

void refine_edges(benchmark::State& state) {
  const Footage& input = footage(false);
  const TagLayout layout = tag_layout("tag36h11", 0);
  const auto corners_px = Detector("tag36h11", {}).detect(input.at(0).luma()).at(0).corners_px;
  for (auto _ : state) benchmark::DoNotOptimize(refine_corners(input.at(0).luma(), input.camera, corners_px, layout));
}
BENCHMARK(refine_edges)->Unit(benchmark::kMillisecond);

void planar_pose(benchmark::State& state) {
  const Footage& input = footage(false);
  const auto corners_px = Detector("tag36h11", {}).detect(input.at(0).luma()).at(0).corners_px;
  for (auto _ : state) benchmark::DoNotOptimize(planar_poses(input.camera, corners_px, 0.08));
}
BENCHMARK(planar_pose)->Unit(benchmark::kMillisecond);

void register_kind(const std::string& kind, bool cluttered) {
  const auto add = [&](const std::string& name, auto&& run) {
    benchmark::RegisterBenchmark((kind + "/" + name).c_str(), run)->Unit(benchmark::kMillisecond);
  };
  add("detect_decimate_1", [=](benchmark::State& state) { detect(state, cluttered, 1); });
  add("detect_decimate_2", [=](benchmark::State& state) { detect(state, cluttered, 2); });
#ifdef CATCHLIGHT_WITH_ARUCO
  add("aruco_apriltag", [=](benchmark::State& state) { aruco(state, cluttered, cv::aruco::CORNER_REFINE_APRILTAG); });
  add("aruco_subpix", [=](benchmark::State& state) { aruco(state, cluttered, cv::aruco::CORNER_REFINE_SUBPIX); });
#endif
  for (const auto& [rung, refinement] : {std::pair("none", Refinement::none), std::pair("corners", Refinement::corners),
                                         std::pair("direct", Refinement::direct)}) {
    add(std::string("follow_") + rung, [=](benchmark::State& state) { track(state, cluttered, refinement, 1 / 24.0); });
    add(std::string("find_anew_") + rung, [=](benchmark::State& state) { track(state, cluttered, refinement, 10); });
  }
}

}  // namespace
}  // namespace catchlight::tracking

int main(int argc, char** argv) {
  catchlight::tracking::register_kind("cluttered", true);
  catchlight::tracking::register_kind("flat", false);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
