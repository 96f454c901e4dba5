#include "render/probe/light_clusters.hpp"

#include <algorithm>
#include <numeric>

namespace catchlight::render {
namespace {

constexpr double kPeakOverSaddle = 2;

// Disjoint sets of cells, each known by its brightest one.
class Watershed {
 public:
  Watershed(const std::vector<double>& luminance, double negligible)
      : luminance_(luminance), negligible_(negligible), parent_(luminance.size(), kNoCluster), light_(luminance.size(), 0.0) {}

  int peak_of(int cell) {
    while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
    return cell;
  }
  bool is_flooded(int cell) const { return parent_[cell] != kNoCluster; }

  // Adds the next cell; cells come from bright to dim.
  void flood(int cell, double light, const std::vector<int>& neighbours) {
    parent_[cell] = cell;
    light_[cell] = light;
    int home = kNoCluster;
    for (const int neighbour : neighbours) {
      if (!is_flooded(neighbour)) continue;
      const int peak = peak_of(neighbour);
      home = home == kNoCluster || home == peak ? peak : meet(home, peak, luminance_[cell]);
    }
    if (home != kNoCluster) join(home, cell);
  }

 private:
  // The brighter of two peaks, whether or not the other becomes part of it.
  int meet(int a, int b, double saddle) {
    if (luminance_[a] < luminance_[b] || (luminance_[a] == luminance_[b] && a > b)) std::swap(a, b);
    if (luminance_[b] < kPeakOverSaddle * saddle || std::min(light_[a], light_[b]) < negligible_) join(a, b);
    return a;
  }
  void join(int into, int peak) {
    parent_[peak] = into;
    light_[into] += light_[peak];
  }

  const std::vector<double>& luminance_;
  double negligible_;
  std::vector<int> parent_;
  std::vector<double> light_;  // luminance times solid angle above the threshold, of the cluster that a peak stands for
};

}  // namespace

LightClusters cluster_lights(const SphereGrid& grid, const std::vector<double>& luminance,
                             const std::vector<double>& solid_angle_sr, double threshold, double negligible) {
  std::vector<int> order(grid.cells());
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](int cell) { return !(luminance[cell] > threshold); });
  std::ranges::stable_sort(order, std::greater{}, [&](int cell) { return luminance[cell]; });

  Watershed watershed(luminance, negligible);
  for (const int cell : order) watershed.flood(cell, (luminance[cell] - threshold) * solid_angle_sr[cell], grid.neighbours(cell));

  LightClusters clusters{std::vector<int>(grid.cells(), kNoCluster), 0};
  for (const int cell : order) {  // a cluster's peak comes first
    const int peak = watershed.peak_of(cell);
    clusters.cluster_of[cell] = peak == cell ? clusters.count++ : clusters.cluster_of[peak];
  }
  return clusters;
}

}  // namespace catchlight::render
