#include "catchlight/tone_curve.hpp"

#include <algorithm>
#include <cmath>

namespace catchlight {
namespace {

/// Light beyond it is not told apart; shaders/tone.frag has the same.
constexpr double kMaxLight = 1e9;

}  // namespace

double ToneCurve::operator()(double luminance) const {
  const double exposed = gain * luminance;
  return exposed * (1 + exposed / (white * white)) / (1 + exposed);
}

glm::dvec3 ToneCurve::operator()(const glm::dvec3& rgb_linear, const glm::dvec3& weights, bool codes_end_at_1) const {
  glm::dvec3 light(0.0);
  for (int c = 0; c < 3; ++c)
    if (!std::isnan(rgb_linear[c])) light[c] = std::clamp(rgb_linear[c], -kMaxLight, kMaxLight);
  const double exposed = gain * std::max(glm::dot(weights, light), 0.0);
  light *= gain * (1 + exposed / (white * white)) / (1 + exposed);
  const double luminance = glm::dot(weights, light), peak = std::max({light.r, light.g, light.b});
  if (codes_end_at_1 && peak > 1)
    light = luminance >= 1 ? glm::dvec3(1.0) : glm::mix(glm::dvec3(luminance), light, (1 - luminance) / (peak - luminance));
  return light;
}

}  // namespace catchlight
