// How tags are tracked.
#pragma once

#include <array>

namespace catchlight::tracking {

/// What follows detection, from exact to cheap.
enum class Refinement {
  direct,   ///< the whole pattern is fitted
  corners,  ///< the four edges are fitted in linear light
  none      ///< the detector's corners are taken
};
constexpr auto names_of(Refinement) {
  return std::array{"direct", "corners", "none"};
}

struct TrackerOptions {
  Refinement refinement = Refinement::direct;
  int max_hamming = 1;
  double coast_s = 0.2;  ///< how long a lost tag's pose is predicted
};

}  // namespace catchlight::tracking
