// What refinement and pose cost on top of detection. Compare the rows of one run; the machine's speed cancels there.
#include <benchmark/benchmark.h>

#include "tests/tracking/synthetic_tag.hpp"
#include "tracking/corner_refinement.hpp"
#include "tracking/detector.hpp"
#include "tracking/families.hpp"
#include "tracking/planar_pose.hpp"

namespace catchlight::tracking {
namespace {

struct Footage {
  SyntheticScene scene;
  SyntheticFrame frame;
};

/// One tag of a sixth of the image's width among sensor noise; `with_lens` adds distortion.
Footage footage(const benchmark::State& state, bool with_lens) {
  Footage result;
  SyntheticScene& scene = result.scene;
  const double scale = static_cast<double>(state.range(0)) / 640;
  scene.camera = with_lens ? distorted_camera() : plain_camera();
  scene.camera.width_px = static_cast<int>(state.range(0));
  scene.camera.height_px = static_cast<int>(state.range(1));
  for (double* value : {&scene.camera.fx_px, &scene.camera.fy_px, &scene.camera.cx_px, &scene.camera.cy_px}) *value *= scale;
  scene.tags.resize(1);
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {300 * scale, 200 * scale}, 0.45, {35, 10, 20});
  scene.noise_codes = 2;
  result.frame = render(scene);
  return result;
}

double decimation(const benchmark::State& state) {
  return static_cast<double>(state.range(2));
}

void detection(benchmark::State& state) {
  const Footage input = footage(state, false);
  Detector detector("tag36h11", {});
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(input.frame.luma(), decimation(state)));
}

void refinement(benchmark::State& state, bool with_lens) {
  const Footage input = footage(state, with_lens);
  const TagLayout layout = tag_layout("tag36h11", 0);
  const auto corners_px = Detector("tag36h11", {}).detect(input.frame.luma(), decimation(state)).at(0).corners_px;
  for (auto _ : state) benchmark::DoNotOptimize(refine_corners(input.frame.luma(), input.scene.camera, corners_px, layout));
}

void pose(benchmark::State& state) {
  const Footage input = footage(state, false);
  const auto corners_px = true_corners_px(input.scene.camera, input.scene.tags[0]);
  for (auto _ : state) benchmark::DoNotOptimize(planar_poses(input.scene.camera, corners_px, 0.08));
}

void tracker(benchmark::State& state) {
  const Footage input = footage(state, false);
  Tracker tracker(input.scene.camera, {});
  double time_s = 0;
  for (auto _ : state) benchmark::DoNotOptimize(tracker.track(input.frame.luma(), time_s += 0.04));
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"width", "height", "decimate"})->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int decimate : {1, 2}) bench->Args({640, 480, decimate})->Args({1280, 720, decimate});
}

BENCHMARK(detection)->Apply(sizes);
BENCHMARK_CAPTURE(refinement, straight, false)->Apply(sizes);
BENCHMARK_CAPTURE(refinement, distorted, true)->Apply(sizes);
BENCHMARK(pose)->Apply(sizes);
BENCHMARK(tracker)->Apply(sizes);

}  // namespace
}  // namespace catchlight::tracking

BENCHMARK_MAIN();
