// Karis, "Real Shading in Unreal Engine 4", 2013: the split sum, with n = v = r for the filter.
#include "render/probe/prefilter.hpp"
#include "catchlight/util/parallel.hpp"
#include "render/math/hemisphere_rays.hpp"
#include "render/probe/cube_map.hpp"
#include "render/probe/light_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kMaxFaceSize = 512, kMinFaceSize = 64, kMinLevels = 6, kMaxLevels = 8;
constexpr std::uint32_t kBrdfSamples = 1024;

// Power of two with about the probe's own angle per texel in the middle of a face.
int face_size_for(const Probe& probe, int wanted) {
  double size = wanted;
  if (wanted <= 0) {
    switch (probe.layout) {
      case ProbeLayout::latlong:
      case ProbeLayout::angular:
      case ProbeLayout::angular_inside:
      case ProbeLayout::mirror_ball:
        size = probe.image.width / kPi;
        break;
      case ProbeLayout::cube_cross:
        size = probe.image.width / 3;
        break;
      case ProbeLayout::cube:
        size = probe.image.width;
        break;
    }
    size = std::min<double>(size, kMaxFaceSize);
  }
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(std::ceil(size), 1.0 * kMinFaceSize))));
}

int level_count_for(int face_size) {
  return std::clamp(std::countr_zero(static_cast<unsigned>(face_size)) - 2, kMinLevels, kMaxLevels);
}

// Mean of the probe over each texel; enough taps that no sun of a single texel falls between them.
Image cube_of(const Probe& probe, const glm::dmat3& probe_from_tag, int size) {
  const int taps = std::clamp(static_cast<int>(std::ceil(4.0 * face_size_for(probe, 0) / size)), 4, 32);
  Image cube(size, 6 * size);
  parallel_for(cube.height, 0, [&](std::size_t row) {
    const int y = static_cast<int>(row) % size;
    const CubeFace& face = gl_cube_faces()[row / size];
    const std::size_t across = static_cast<std::size_t>(size) * taps;
    Coordinates3 directions(across);
    std::vector<glm::vec3> radiance(across);
    std::vector<glm::dvec3> sums(size, glm::dvec3(0));
    const auto place = [&](std::size_t tap) { return 2 * ((static_cast<double>(tap) + 0.5) / taps) / size - 1; };
    for (int tap_row = 0; tap_row < taps; ++tap_row) {
      const glm::dvec3 left = probe_from_tag * (face.centre + place(static_cast<std::size_t>(y) * taps + tap_row) * face.down);
      const glm::dvec3 right = probe_from_tag * face.right;
      for (std::size_t i = 0; i < across; ++i) {
        const glm::dvec3 direction = left + place(i) * right;
        directions.x[i] = direction.x, directions.y[i] = direction.y, directions.z[i] = direction.z;
      }
      sample(probe, directions, radiance);
      for (std::size_t i = 0; i < across; ++i) sums[i / taps] += glm::dvec3(radiance[i]);
    }
    for (int x = 0; x < size; ++x)
      for (int c = 0; c < 3; ++c) cube.pixel(x, static_cast<int>(row))[c] = static_cast<float>(sums[x][c] / (taps * taps));
  });
  return cube;
}

// Half vector of GGX with density D (n . h) (Walter et al. 2007, eq. 35, 36).
glm::dvec3 ggx_half_vector(const glm::dvec2& square, double alpha) {
  const double cos2 = (1 - square.x) / (1 + (alpha * alpha - 1) * square.x), sin = std::sqrt(1 - cos2), phi = 2 * kPi * square.y;
  return {sin * std::cos(phi), sin * std::sin(phi), std::sqrt(cos2)};
}

Image filtered(const LightTree& light, int size, double roughness) {
  Image level(size, 6 * size);
  parallel_for(level.height, 0, [&](std::size_t row) {
    const int y = static_cast<int>(row) % size, face = static_cast<int>(row) / size;
    std::vector<glm::vec3> directions(size), means(size);
    for (int x = 0; x < size; ++x) directions[x] = glm::vec3(cube_texel_direction(face, size, x, y));
    light.under_lobes(directions, static_cast<float>(roughness * roughness), means);
    for (int x = 0; x < size; ++x)
      for (int c = 0; c < 3; ++c) level.pixel(x, static_cast<int>(row))[c] = means[x][c];
  });
  return level;
}

// Height-correlated Smith visibility G / (4 n.l n.v) (Heitz 2014), without its cancelling parts near grazing angles.
double smith_visibility(double n_l, double n_v, double alpha) {
  const double a2 = alpha * alpha;
  return 0.5 / (n_l * std::sqrt(n_v * n_v * (1 - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1 - a2) + a2));
}

// Half vectors of a roughness: the same for all directions of view.
std::vector<glm::dvec3> ggx_half_vectors(double alpha) {
  std::vector<glm::dvec3> halves(kBrdfSamples);
  for (std::uint32_t k = 0; k < kBrdfSamples; ++k) halves[k] = ggx_half_vector(scrambled_sobol(k, 2), alpha);
  return halves;
}

glm::dvec2 integrated_brdf(double n_v, double alpha, const std::vector<glm::dvec3>& halves) {
  const glm::dvec3 view(std::sqrt(1 - n_v * n_v), 0, n_v);
  glm::dvec2 sum(0);
  for (const glm::dvec3& half : halves) {
    const double v_h = std::max(glm::dot(view, half), 1e-9), n_l = 2 * v_h * half.z - view.z;
    if (n_l <= 0) continue;
    const double value = smith_visibility(n_l, n_v, alpha) * 4 * n_l * v_h / half.z;
    const double past = 1 - v_h, fresnel = past * past * past * past * past;
    sum += value * glm::dvec2(1 - fresnel, fresnel);
  }
  return sum / static_cast<double>(kBrdfSamples);
}

}  // namespace

ReflectionMap prefilter_reflections(const Probe& probe, const glm::dmat3& tag_from_probe, int face_size) {
  const int size = face_size_for(probe, face_size), levels = level_count_for(size);
  ReflectionMap map;
  map.levels.push_back(cube_of(probe, glm::transpose(tag_from_probe), size));
  const LightTree light(map.levels.front());
  for (int k = 1; k < levels; ++k) map.levels.push_back(filtered(light, size >> k, static_cast<double>(k) / (levels - 1)));
  return map;
}

Image environment_brdf_table(int size) {
  Image table(size, size, 2);
  parallel_for(size, 0, [&](std::size_t row) {
    const double roughness = (static_cast<double>(row) + 0.5) / size, alpha = roughness * roughness;
    const std::vector<glm::dvec3> halves = ggx_half_vectors(alpha);
    for (int x = 0; x < size; ++x) {
      const glm::dvec2 value = integrated_brdf((x + 0.5) / size, alpha, halves);
      table.pixel(x, static_cast<int>(row))[0] = static_cast<float>(value.x);
      table.pixel(x, static_cast<int>(row))[1] = static_cast<float>(value.y);
    }
  });
  return table;
}

}  // namespace catchlight::render
