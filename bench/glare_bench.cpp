// Glare, as a processor makes it and as GL draws it, in processor time: extracting, spreading, and reading the frame's rows.
#include <benchmark/benchmark.h>

#include "render/cpu/glare/grid_glare.hpp"
#include "render/gl/gl_context.hpp"
#include "tests/support/glare_fixture.hpp"
#include "tests/support/glare_scenes.hpp"

namespace catchlight::render::test {
namespace {

constexpr int kWidth = 960, kHeight = 720;
constexpr PixelRect kFrame{0, 0, kWidth, kHeight};

/// One of glare_scenes(), premultiplied RGBA; after them one without anything bright.
Image picture(std::int64_t scene) {
  const std::vector<NamedScene> scenes = glare_scenes();
  Image rgba(kWidth, kHeight, 4);
  if (scene >= static_cast<std::int64_t>(scenes.size())) return rgba;
  const Image rgb = scenes[static_cast<std::size_t>(scene)].make(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) std::copy_n(rgb.pixel(x, y), 3, rgba.pixel(x, y));
  return rgba;
}

void cpu(benchmark::State& state) {
  const Image object = picture(state.range(0));
  GridGlare glare(GlareSettings{});
  for (auto _ : state)
    if (glare.extract(object, nullptr, kFrame, kWidth, kHeight)) benchmark::DoNotOptimize(glare.spread({}));
}

void cpu_rows(benchmark::State& state) {
  const Image object = picture(state.range(0));
  GridGlare glare(GlareSettings{});
  if (!glare.extract(object, nullptr, kFrame, kWidth, kHeight)) return state.SkipWithError("nothing is bright");
  const PixelRect reach = glare.spread({});
  std::vector<float> rgb(3 * kWidth);
  for (auto _ : state)
    for (int y = reach.y; y < reach.y + reach.height; ++y) glare.read_row(reach.x, y, reach.width, rgb.data());
  state.counters["pixels"] = static_cast<double>(reach.width) * reach.height;
}

void gl(benchmark::State& state) {
  const Image rgba = picture(state.range(0));
  GlTexture object = make_texture_2d("picture", GL_RGBA32F, kWidth, kHeight);
  glTextureSubImage2D(object.id(), 0, 0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, rgba.data.data());
  ShaderLibrary shaders;
  GlarePass glare(GlareSettings{}, shaders);
  for (auto _ : state) {
    if (glare.extract(object, nullptr, kFrame, kWidth, kHeight)) benchmark::DoNotOptimize(glare.spread());
    glFinish();
  }
}

BENCHMARK(cpu)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(cpu_rows)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(gl)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace catchlight::render::test

int main(int argc, char** argv) {
  const auto context = catchlight::render::make_headless_context();
  benchmark::AddCustomContext("renderer", catchlight::render::gl_info().renderer);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
