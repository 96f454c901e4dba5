// Light without GL: projection, prefiltering and baking. `rays` counters are rays a second.
#include <benchmark/benchmark.h>

#include <cmath>

#include "catchlight/image.hpp"
#include "render/math/hemisphere_rays.hpp"
#include "render/probe/prefilter.hpp"
#include "render/probe/probe.hpp"
#include "render/probe/probe_split.hpp"
#include "render/rays/ray_scene.hpp"
#include "render/transfer/transfer.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

Probe gradient_probe(int width) {
  Probe probe{Image(width, width / 2), ProbeLayout::latlong};
  for (std::size_t i = 0; i < probe.image.data.size(); ++i) probe.image.data[i] = 1 + std::sin(0.001f * static_cast<float>(i));
  return probe;
}

// Two spheres, so that a good part of the rays is occluded: 2 * (rows + 1) * (2 rows + 1) vertices.
Mesh two_spheres(int rows) {
  Mesh mesh = sphere({0, 0, 1}, 1, rows);
  append(mesh, sphere({1.5f, 0, 1}, 1, rows));
  return mesh;
}

void project(benchmark::State& state) {
  const Probe probe = gradient_probe(512);
  for (auto _ : state) benchmark::DoNotOptimize(project_to_sh(probe, static_cast<int>(state.range(0))));
}
BENCHMARK(project)->DenseRange(1, 9, 2)->Unit(benchmark::kMillisecond)->UseRealTime();

void prefilter(benchmark::State& state) {
  const Probe probe = gradient_probe(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(prefilter_reflections(probe, glm::dmat3(1)));
}
BENCHMARK(prefilter)->Arg(128)->Arg(512)->Unit(benchmark::kMillisecond)->UseRealTime();

void bake_by_bands(benchmark::State& state) {
  const Mesh mesh = two_spheres(24);
  TransferOptions options;
  options.rays = 128;
  options.bands = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(bake_transfer(mesh, {}, options, {}));
  state.counters["rays"] =
      benchmark::Counter(static_cast<double>(mesh.vertices.size()) * options.rays, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(bake_by_bands)->DenseRange(1, 9, 2)->Unit(benchmark::kMillisecond)->UseRealTime();

// What a scene of 20 000 vertices has to wait for: 5 bands, 512 rays, two bounces, a receiver that sends light back.
void bake_20k_vertices(benchmark::State& state) {
  const Mesh mesh = two_spheres(70);
  TransferOptions options;
  options.bands = 5;
  options.rays = 512;
  options.bounces = 2;
  options.receiver_albedo = constant_albedo(glm::vec3(0.8f));
  const ReceiverGrid grid = receiver_grid_for(mesh, 96);
  for (auto _ : state) benchmark::DoNotOptimize(bake_transfer(mesh, grid, options, {}));
  state.counters["vertices"] = static_cast<double>(mesh.vertices.size());
}
BENCHMARK(bake_20k_vertices)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);

// Whenever light and tag turn against each other.
void rotate_light(benchmark::State& state) {
  const int bands = static_cast<int>(state.range(0));
  const ShRgb light(sh_count(bands), glm::vec3(1));
  double angle = 0;
  for (auto _ : state) {
    angle += 0.1;
    const glm::dmat3 rotation(glm::dvec3(std::cos(angle), std::sin(angle), 0), glm::dvec3(-std::sin(angle), std::cos(angle), 0),
                              glm::dvec3(0, 0, 1));
    benchmark::DoNotOptimize(rotate_sh(light, rotation));
  }
}
BENCHMARK(rotate_light)->Arg(3)->Arg(5)->Arg(7)->Arg(10)->Unit(benchmark::kMicrosecond);

void split_probe(benchmark::State& state) {
  Probe probe = gradient_probe(static_cast<int>(state.range(0)));
  for (int c = 0; c < 3; ++c) probe.image.pixel(probe.image.width / 3, probe.image.height / 3)[c] = 1e5f;
  for (auto _ : state) benchmark::DoNotOptimize(split_lights(probe, {}));
}
BENCHMARK(split_probe)->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();

// One ray at a time, against the same rays tested with every triangle in turn.
template <typename Occluded>
void cast_rays(benchmark::State& state, const Occluded& occluded) {
  std::vector<float> x(4096), y(4096), z(4096);
  HemisphereRays(4096).fill_hemisphere(glm::vec3(0, 0, 1), 1, {x, y, z});
  std::size_t k = 0;
  for (auto _ : state) {
    k = (k + 1237) % 4096;  // neighbours go the same way: take others
    benchmark::DoNotOptimize(occluded(glm::vec3(1, 1, 0), glm::vec3(x[k], y[k], z[k])));
  }
  state.counters["rays"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void cast_with_embree(benchmark::State& state) {
  const Mesh mesh = two_spheres(static_cast<int>(state.range(0)));
  const RayScene scene(mesh);
  cast_rays(state, [&](const glm::vec3& origin, const glm::vec3& direction) { return scene.occluded(origin, direction); });
}
BENCHMARK(cast_with_embree)->Arg(8)->Arg(32)->Arg(70);

bool hits_triangle(const glm::vec3& origin, const glm::vec3& direction, const glm::vec3& a, const glm::vec3& b,
                   const glm::vec3& c) {
  const glm::vec3 e1 = b - a, e2 = c - a, p = glm::cross(direction, e2), t = origin - a, q = glm::cross(t, e1);
  const float det = glm::dot(e1, p), u = glm::dot(t, p) / det, v = glm::dot(direction, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && glm::dot(e2, q) / det > 0;
}

void cast_by_brute_force(benchmark::State& state) {
  const Mesh mesh = two_spheres(static_cast<int>(state.range(0)));
  const auto corner = [&](std::size_t i) { return mesh.vertices[mesh.indices[i]].position_m; };
  cast_rays(state, [&](const glm::vec3& origin, const glm::vec3& direction) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      if (hits_triangle(origin, direction, corner(i), corner(i + 1), corner(i + 2))) return true;
    }
    return false;
  });
}
BENCHMARK(cast_by_brute_force)->Arg(8)->Arg(32)->Arg(70);

}  // namespace
}  // namespace catchlight::render

BENCHMARK_MAIN();
