// How tags are tracked.
#pragma once

namespace catchlight::tracking {

/// What follows detection, from cheap to exact.
enum class Refinement {
  none,     ///< the detector's corners
  corners,  ///< its four edges, fitted in linear light
  direct    ///< the whole pattern
};

struct TrackerOptions {
  Refinement refinement = Refinement::direct;
  int max_hamming = 1;
  double coast_s = 0.2;  ///< how long a lost tag's pose is predicted
};

}  // namespace catchlight::tracking
