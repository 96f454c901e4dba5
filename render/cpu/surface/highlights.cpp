#include "render/cpu/surface/highlights.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/render_scene.hpp"
#include "shaders/shading.h"

namespace catchlight::render {

void Highlights::set_samples(std::span<const LightSample> samples_tag) {
  x_.clear(), y_.clear(), z_.clear(), spread2_.clear(), irradiance_.clear(), number_.clear();
  for (std::size_t i = 0; i < samples_tag.size(); ++i) {
    const LightSample& sample = samples_tag[i];
    if (!sample.compact) continue;
    x_.push_back(static_cast<float>(sample.direction.x)), y_.push_back(static_cast<float>(sample.direction.y));
    z_.push_back(static_cast<float>(sample.direction.z));
    const auto spread = static_cast<float>(sample.spread_rad);
    spread2_.push_back(spread * spread);
    irradiance_.push_back(float4(glm::vec3(sample.irradiance)));
    number_.push_back(i);
  }
}

namespace {

/// What all samples have in common.
struct View {
  glm::vec3 n, v;
  float a2;  ///< alpha^2
};

/// Arrays of `count` values: the lights' directions and squared spreads in, shading::glossy_brdf() times n.l as factors of f0 and
/// f90 out.
[[gnu::target_clones("avx2", "default")]] void evaluate(const View& view, std::size_t count, const float* x, const float* y,
                                                        const float* z, const float* spread2, float* of_f0, float* of_f90) {
  const auto [n, v, a2] = view;
  const float n_v = std::max(glm::dot(n, v), 1e-4f), masked_view = std::sqrt(n_v * n_v * (1 - a2) + a2);
  for (std::size_t i = 0; i < count; ++i) {
    const float hx = v.x + x[i], hy = v.y + y[i], hz = v.z + z[i];
    const float h2 = std::max(hx * hx + hy * hy + hz * hz, 1e-12f), one_over_h = 1 / std::sqrt(h2);
    const float n_l = n.x * x[i] + n.y * y[i] + n.z * z[i], lit = std::max(n_l, 1e-12f);
    const float n_h = std::max((n.x * hx + n.y * hy + n.z * hz) * one_over_h, 0.0f);
    const float v_h = std::max((v.x * hx + v.y * hy + v.z * hz) * one_over_h, 0.0f);
    const float wide2 = std::min(a2 + spread2[i], 1.0f), d = n_h * n_h * (wide2 - 1) + 1;
    const float shadowing = lit * masked_view + n_v * std::sqrt(lit * lit * (1 - a2) + a2);
    const float brdf = std::max(n_l, 0.0f) * wide2 * 0.5f / (shading::kPi * d * d * shadowing);
    const float m = 1 - v_h, m2 = m * m, grazing = m2 * m2 * m;
    of_f0[i] = brdf * (1 - grazing);
    of_f90[i] = brdf * grazing;
  }
}

}  // namespace

glm::vec3 Highlights::radiance(const GlossySurface& surface, const float* shares) const {
  std::array<float, kMaxLightSamples> of_f0, of_f90;
  const std::size_t count = x_.size();
  evaluate({surface.normal, surface.to_viewer, surface.alpha * surface.alpha}, count, x_.data(), y_.data(), z_.data(),
           spread2_.data(), of_f0.data(), of_f90.data());
  Float4 sum_f0{}, sum_f90{};
  for (std::size_t i = 0; i < count; ++i) {
    const float share = shares[number_[i]];
    if (share == 0) continue;
    sum_f0 += irradiance_[i] * splat(share * of_f0[i]);
    sum_f90 += irradiance_[i] * splat(share * of_f90[i]);
  }
  return surface.f0 * rgb(sum_f0) + surface.f90 * rgb(sum_f90);
}

}  // namespace catchlight::render
