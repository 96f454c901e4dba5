#include "render/cpu/mirror/lobe_directions.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/shading.h"

namespace catchlight::render {

LobePoints LobePoints::dealt(int count, int sharers, int sharer) {
  LobePoints points;
  sharers = std::min(sharers, count);
  for (int first = 0; first < count; first += sharers) {
    const int number = first + (sharer ^ (first / sharers)) % sharers;
    if (number >= count) continue;
    const glm::vec2 square = shading::hammersley(number, count), disc = shading::disc_point(square);
    points.number.push_back(number);
    points.across.push_back(square.x - 0.5f), points.down.push_back(square.y - 0.5f);
    points.disc_x.push_back(disc.x), points.disc_y.push_back(disc.y);
  }
  return points;
}

namespace {

/// Writes shading::visible_normal() for each point of the disc, in the frame of the surface.
[[gnu::target_clones("avx2", "default")]] void find_facets(const glm::vec3& viewer, float alpha, std::size_t count,
                                                           const float* disc_x, const float* disc_y, float* __restrict x,
                                                           float* __restrict y, float* __restrict z) {
  const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * viewer.x, alpha * viewer.y, viewer.z));
  const float across2 = stretched.x * stretched.x + stretched.y * stretched.y;
  const glm::vec3 t1 = across2 > 0 ? glm::vec3(-stretched.y, stretched.x, 0) * glm::inversesqrt(across2) : glm::vec3(1, 0, 0);
  const glm::vec3 t2 = glm::cross(stretched, t1);
  const float s = 0.5f * (1 + stretched.z);
  for (std::size_t i = 0; i < count; ++i) {
    const float p1 = disc_x[i], p2 = std::sqrt(1 - p1 * p1) * (1 - s) + disc_y[i] * s;
    const float p3 = std::sqrt(std::max(1 - p1 * p1 - p2 * p2, 0.0f));
    const float nx = alpha * (p1 * t1.x + p2 * t2.x + p3 * stretched.x);
    const float ny = alpha * (p1 * t1.y + p2 * t2.y + p3 * stretched.y);
    const float nz = std::max(p1 * t1.z + p2 * t2.z + p3 * stretched.z, 0.0f);
    const float one_over_length = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
    x[i] = nx * one_over_length, y[i] = ny * one_over_length, z[i] = nz * one_over_length;
  }
}

/// Turns facets into what they mirror. `frame` leads from theirs to the tag's.
[[gnu::target_clones("avx2", "default")]] void mirror_by_facets(const Lobe& lobe, const glm::mat3& frame, std::size_t count,
                                                                const float* across, const float* down, float* __restrict x,
                                                                float* __restrict y, float* __restrict z,
                                                                float* __restrict weight) {
  const auto [v, n, du, dv, alpha] = lobe;
  const glm::vec3 f1 = frame[0], f2 = frame[1], f3 = frame[2];
  const float a2 = alpha * alpha;
  for (std::size_t i = 0; i < count; ++i) {
    const float hx = f1.x * x[i] + f2.x * y[i] + f3.x * z[i];
    const float hy = f1.y * x[i] + f2.y * y[i] + f3.y * z[i];
    const float hz = f1.z * x[i] + f2.z * y[i] + f3.z * z[i];
    const float twice = 2 * (hx * v.x + hy * v.y + hz * v.z);
    const float dx = twice * hx - v.x + across[i] * du.x + down[i] * dv.x;
    const float dy = twice * hy - v.y + across[i] * du.y + down[i] * dv.y;
    const float dz = twice * hz - v.z + across[i] * du.z + down[i] * dv.z;
    const float above = dx * n.x + dy * n.y + dz * n.z;
    const float one_over_length = 1 / std::sqrt(dx * dx + dy * dy + dz * dz);
    const float shown = 2 * above / (above + std::sqrt(a2 + (1 - a2) * above * above));  // shading::lobe_weight()
    x[i] = dx * one_over_length, y[i] = dy * one_over_length, z[i] = dz * one_over_length;
    weight[i] = above > 0 ? shown : 0;
  }
}

}  // namespace

void LobeDirections::find(const Lobe& lobe, const LobePoints& points, std::size_t count) {
  const glm::mat3 frame = shading::frame_around(lobe.normal);
  x_.assign(count, 0), y_.assign(count, 0), z_.assign(count, 1), weight_.resize(count);
  if (lobe.alpha > 0)
    find_facets(lobe.to_viewer * frame, lobe.alpha, count, points.disc_x.data(), points.disc_y.data(), x_.data(), y_.data(),
                z_.data());
  mirror_by_facets(lobe, frame, count, points.across.data(), points.down.data(), x_.data(), y_.data(), z_.data(), weight_.data());
}

}  // namespace catchlight::render
