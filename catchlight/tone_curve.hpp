// The curve that takes scene light to what a picture can hold: Reinhard et al. 2002 (render/tone/tone_curve.hpp finds it).
#pragma once

#include <glm/glm.hpp>

namespace catchlight {

/// L (1 + L / white^2) / (1 + L) of L = gain * luminance. The default changes nothing.
struct ToneCurve {
  double gain = 1;
  double white = 1;  ///< the exposed luminance that becomes 1; infinite: none does

  double operator()(double luminance) const;

  /// RGB scaled by the luminance's ratio, so that colour keeps its own. NaN is black, as is what is not light at all. Where codes
  /// end at 1, a colour beyond is mixed with the grey of its luminance until it fits.
  glm::dvec3 operator()(const glm::dvec3& rgb_linear, const glm::dvec3& luminance_weights, bool codes_end_at_1) const;
};

}  // namespace catchlight
