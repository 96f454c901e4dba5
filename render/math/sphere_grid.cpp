#include "render/math/sphere_grid.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace catchlight::render {

SphereGrid::SphereGrid(int rings) : rings_(rings), first_{0} {
  for (int ring = 0; ring < rings; ++ring) {
    const double latitude = ((ring + 0.5) / rings - 0.5) * glm::pi<double>();
    first_.push_back(first_.back() + std::max(3, static_cast<int>(std::lround(2 * rings * std::cos(latitude)))));
  }
}

int SphereGrid::ring_of(int cell) const {
  return static_cast<int>(std::ranges::upper_bound(first_, cell) - first_.begin()) - 1;
}

int SphereGrid::ring_at(double y) const {
  const double latitude = std::asin(std::clamp(y, -1.0, 1.0)) / glm::pi<double>() + 0.5;
  return std::clamp(static_cast<int>(latitude * rings_), 0, rings_ - 1);
}

double SphereGrid::turn_of(const glm::dvec3& direction) {
  return std::atan2(direction.x, direction.z) / glm::two_pi<double>() + 0.5;
}

int SphereGrid::cell_at(int ring, double turn) const {
  return first_[ring] + std::clamp(static_cast<int>(turn * columns(ring)), 0, columns(ring) - 1);
}

glm::dvec3 SphereGrid::middle_of(int cell) const {
  const int ring = ring_of(cell);
  const double latitude = ((ring + 0.5) / rings_ - 0.5) * glm::pi<double>();
  const double longitude = ((cell - first_[ring] + 0.5) / columns(ring) - 0.5) * glm::two_pi<double>();
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude), std::cos(latitude) * std::cos(longitude)};
}

// Cells of `ring` between `from` and `to`, in turns.
void SphereGrid::add_overlapping(int ring, double from, double to, std::vector<int>& cells) const {
  const int count = columns(ring);
  const int begin = static_cast<int>(std::floor(from * count)), end = static_cast<int>(std::floor(to * count));
  for (int column = begin; column <= std::min(end, begin + count - 1); ++column)
    cells.push_back(first_[ring] + (column % count + count) % count);
}

std::vector<int> SphereGrid::neighbours(int cell) const {
  const int ring = ring_of(cell), column = cell - first_[ring];
  const double width = 1.0 / columns(ring), from = column * width;
  std::vector<int> cells;
  for (int other = std::max(ring - 1, 0); other <= std::min(ring + 1, rings_ - 1); ++other) {
    const double aside = 0.5 / std::max(columns(ring), columns(other)) + 1e-9;  // the same seen from the other cell
    add_overlapping(other, from - aside, from + width + aside, cells);
  }
  // Across a pole lie the cells of its own ring.
  if (ring == 0 || ring == rings_ - 1) add_overlapping(ring, 0, 1 - 0.5 * width, cells);
  std::ranges::sort(cells);
  const auto repeated = std::ranges::unique(cells);
  cells.erase(repeated.begin(), repeated.end());
  std::erase(cells, cell);
  return cells;
}

}  // namespace catchlight::render
