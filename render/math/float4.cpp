#include "render/math/float4.hpp"

#include <cstddef>
#include <limits>

namespace catchlight::render {

bool any_above(const float* rgba, int pixels, float threshold) {
  const Float4 limits{threshold, threshold, threshold, std::numeric_limits<float>::infinity()};
  auto found = limits > limits;
  for (int i = 0; i < pixels; ++i) found |= load(rgba + 4 * static_cast<std::ptrdiff_t>(i)) > limits;
  return (found[0] | found[1] | found[2]) != 0;
}

}  // namespace catchlight::render
