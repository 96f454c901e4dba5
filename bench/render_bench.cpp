// Milliseconds a frame and a pass at two sizes of picture; the object fills a third of its height.
#include <benchmark/benchmark.h>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "render/frame_view.hpp"
#include "render/gl_compositor.hpp"
#include "render/render_scene.hpp"
#include "tests/support/gl_fixture.hpp"

namespace catchlight::render::test {
namespace {

/// A ball of 18 000 triangles over its shadow, 6 bands; `glares` decides whether anything exceeds white.
RenderScene ball_scene(bool glares) {
  Material gloss;
  gloss.base_color = {0.7f, 0.5f, 0.3f};
  gloss.roughness = 0.2f;
  RenderScene scene = constant_scene(sphere(0.05, {0, 0, 0.06}, 96), gloss, glm::vec3(0.6f), 6);
  scene.reflections =
      reflections_of([&](const glm::dvec3& d) { return glm::vec3(glares && d.z > 0.97 ? 200.0f : 0.4f); }, 128, 7);
  add_receiver(scene.transfer, {.min_m = {-0.15f, -0.15f}, .max_m = {0.15f, 0.15f}, .columns = 96, .rows = 96},
               [](double x, double y) { return 1 - 0.7 * std::exp(-(x * x + y * y) / 0.003); });
  return scene;
}

void frame(benchmark::State& state) {
  const auto height = static_cast<int>(state.range(0)), width = height == 480 ? 640 : 1280;
  const bool glares = state.range(1) != 0;
  GlCompositor compositor(ball_scene(glares), {});
  FrameView view = view_from_above(0.5);
  view.camera = {.width_px = width,
                 .height_px = height,
                 .fx_px = 1.6 * height,
                 .fy_px = 1.6 * height,
                 .cx_px = width / 2.0 - 0.5,
                 .cy_px = height / 2.0 - 0.5,
                 .distortion = {}};
  const PlateReader plate = [](const PixelRect& rect) {
    return Plate{rect, Plate::Format::rgb_u8,
                 RawVector<std::byte>(static_cast<std::size_t>(rect.width) * rect.height * 3, std::byte{90})};
  };
  compositor.render(view, plate);  // buffers are made and the light is evaluated once
  for (auto _ : state) {
    benchmark::DoNotOptimize(compositor.render(view, plate));
    for (const PassTime& pass : compositor.pass_times()) state.counters[pass.name + "_ms"] += pass.ms;
  }
  for (auto& [name, counter] : state.counters) counter.flags = benchmark::Counter::kAvgIterations;
}
BENCHMARK(frame)
    ->ArgNames({"rows", "glare"})
    ->ArgsProduct({{480, 720}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace catchlight::render::test

int main(int argc, char** argv) {
  const auto context = catchlight::render::make_headless_context();
  benchmark::AddCustomContext("renderer", catchlight::render::gl_info().renderer);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
