// Which parts of a brightness over the sphere belong together as one light.
#pragma once

#include <vector>

#include "render/math/sphere_grid.hpp"

namespace catchlight::render {

inline constexpr int kNoCluster = -1;

struct LightClusters {
  std::vector<int> cluster_of;  ///< a cell; kNoCluster at and below the threshold
  int count = 0;
};

/// Watershed of `luminance` (a value a cell) above `threshold`: every peak grows downwards, and two that meet become one only
/// where one is no peak of its own, less than twice as bright as the saddle between them, or brings less than `negligible` of
/// luminance times solid angle above the threshold (`solid_angle_sr`: a value a cell). Lights are never merged because they are
/// near.
LightClusters cluster_lights(const SphereGrid& grid, const std::vector<double>& luminance,
                             const std::vector<double>& solid_angle_sr, double threshold, double negligible);

}  // namespace catchlight::render
