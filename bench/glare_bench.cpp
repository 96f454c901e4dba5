// Glare and tone, as a processor makes them and as GL draws them, in processor time.
#include <benchmark/benchmark.h>

#include "render/cpu/glare/grid_glare.hpp"
#include "render/cpu/tone/cpu_tone.hpp"
#include "render/gl/gl_context.hpp"
#include "render/passes/tone_pass.hpp"
#include "shaders/interface.h"
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

GlTexture uploaded(const Image& rgba) {
  GlTexture texture = make_texture_2d("picture", GL_RGBA32F, rgba.width, rgba.height);
  glTextureSubImage2D(texture.id(), 0, 0, 0, rgba.width, rgba.height, GL_RGBA, GL_FLOAT, rgba.data.data());
  return texture;
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
  const GlTexture object = uploaded(rgba);
  ShaderLibrary shaders;
  GlarePass glare(GlareSettings{}, shaders);
  for (auto _ : state) {
    if (glare.extract(object, nullptr, kFrame, kWidth, kHeight)) benchmark::DoNotOptimize(glare.spread());
    glFinish();
  }
}

/// A composite: the first scene over a plate of all codes.
Image daylight() {
  Image light = picture(0);
  for (std::size_t i = 0; i < light.data.size(); ++i) light.data[i] += 1e-3f * static_cast<float>((i * 7919) % 1000);
  return light;
}

CompositorSettings toned(benchmark::State& state) {
  CompositorSettings settings;
  settings.tone.enabled = true;
  settings.look = state.range(0) == 0 ? Look::camera : Look::classic;
  return settings;
}

void cpu_tone(benchmark::State& state) {
  const Image light = daylight();
  CpuTone tone(toned(state));
  for (auto _ : state) {
    Image codes = light;
    tone.apply(codes, {}, tone.meter(codes, {}), true);
    benchmark::DoNotOptimize(codes.data.data());
  }
}

void gl_tone(benchmark::State& state) {
  const GlTexture light = uploaded(daylight());
  ShaderLibrary shaders;
  TonePass tone(toned(state), shaders);
  UniformBuffer<shader_interface::CompositeUniforms> uniforms("composite");
  shader_interface::CompositeUniforms block{};
  block.modes = {TRANSFER_SRGB, 1, 0, 1};
  uniforms.update(block);
  uniforms.bind(BINDING_COMPOSITE);
  for (auto _ : state) {
    const ToneCurve curve = tone.meter(light, kWidth, kHeight, {});
    tone.draw_glare(light, kWidth, kHeight);
    tone.draw(light, kWidth, kHeight, {}, curve);
    benchmark::DoNotOptimize(tone.read());
  }
}

BENCHMARK(cpu_tone)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(gl_tone)->DenseRange(0, 1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
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
