// A picture's texels as the coefficients of a cubic B-spline, as shaders/bspline.glsl reads them.
#pragma once

#include <array>
#include <cmath>

namespace catchlight::render {

/// Weights of four texels from `first`, along one axis.
struct SplineSamples {
  int first;
  std::array<float, 4> weights;
};

/// The samples at a position in texels; the first one's centre is at 0.5.
inline SplineSamples spline_at(double texel) {
  const double first = std::floor(texel - 0.5), f = texel - 0.5 - first, g = 1.0 - f;
  const auto weight = [](double w) { return static_cast<float>(w / 6); };
  return {static_cast<int>(first) - 1,
          {weight(g * g * g), weight(4 - 6 * f * f + 3 * f * f * f), weight(4 - 6 * g * g + 3 * g * g * g), weight(f * f * f)}};
}

}  // namespace catchlight::render
