#include "catchlight/tone_curve.hpp"

namespace catchlight {

double ToneCurve::operator()(double luminance) const {
  const double exposed = gain * luminance;
  return exposed * (1 + exposed / (white * white)) / (1 + exposed);
}

}  // namespace catchlight
