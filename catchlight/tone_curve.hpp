// The curve that takes scene light to what a picture can hold: Reinhard et al. 2002 (render/tone/tone_curve.hpp finds it).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace catchlight {

/// L (1 + L / white^2) / (1 + L) of L = gain * luminance. The default changes nothing.
struct ToneCurve {
  double gain = 1;
  double white = 1;  ///< the exposed luminance that becomes 1; infinite: none does

  double operator()(double luminance) const;

  /// RGB scaled by the luminance's ratio, so that colour keeps its own. NaN is black, as is what is not light at all. Where codes
  /// end at 1, a colour beyond is mixed with the grey of its luminance until it fits.
  template <typename T>
  glm::vec<3, T> operator()(const glm::vec<3, T>& rgb_linear, const glm::vec<3, T>& luminance_weights, bool codes_end_at_1) const;
};

template <typename T>
glm::vec<3, T> ToneCurve::operator()(const glm::vec<3, T>& rgb_linear, const glm::vec<3, T>& luminance_weights,
                                     bool codes_end_at_1) const {
  constexpr T kMaxLight(1e9);  // light beyond it is not told apart; shaders/tone.frag has the same
  glm::vec<3, T> light(0);
  for (int c = 0; c < 3; ++c)
    if (!std::isnan(rgb_linear[c])) light[c] = std::clamp(rgb_linear[c], -kMaxLight, kMaxLight);
  const T exposed = T(gain) * std::max(glm::dot(luminance_weights, light), T(0));
  light *= T(gain) * (1 + exposed * T(1 / (white * white))) / (1 + exposed);
  const T luminance = glm::dot(luminance_weights, light), peak = std::max({light.r, light.g, light.b});
  if (!codes_end_at_1 || !(peak > 1)) return light;
  if (luminance >= 1) return glm::vec<3, T>(1);
  return glm::mix(glm::vec<3, T>(luminance), light, (1 - luminance) / (peak - luminance));
}

}  // namespace catchlight
