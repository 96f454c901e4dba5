// Slopes of maps between pixels, to hold derivatives against.
#pragma once

#include <gtest/gtest.h>

#include <glm/glm.hpp>

namespace catchlight::tests {

inline void expect_near(const glm::dmat2& a, const glm::dmat2& b, double tolerance) {
  for (int column = 0; column < 2; ++column)
    for (int row = 0; row < 2; ++row) EXPECT_NEAR(a[column][row], b[column][row], tolerance) << column << ", " << row;
}

/// Columns: along x, along y.
template <class Map>
glm::dmat2 finite_differences(const glm::dvec2& at, Map&& map) {
  constexpr double kStep_px = 1e-2;
  const glm::dvec2 x(kStep_px, 0), y(0, kStep_px);
  return {(map(at + x) - map(at - x)) / (2 * kStep_px), (map(at + y) - map(at - y)) / (2 * kStep_px)};
}

}  // namespace catchlight::tests
