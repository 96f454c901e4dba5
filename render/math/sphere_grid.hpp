// The sphere in rings of nearly equal cells: sums over directions that do not depend on a probe's layout.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace catchlight::render {

/// `rings` bands of latitude about +y, each divided into as many cells as keeps them nearly square.
class SphereGrid {
 public:
  explicit SphereGrid(int rings);

  int cells() const { return first_.back(); }
  int cell_of(const glm::dvec3& direction) const { return cell_at(ring_at(direction.y), turn_of(direction)); }
  /// The ring that holds directions of that y (length 1).
  int ring_at(double y) const;
  /// Where the direction lies in its ring, from 0 to 1.
  static double turn_of(const glm::dvec3& direction);
  int cell_at(int ring, double turn) const;
  glm::dvec3 middle_of(int cell) const;

  /// Cells that share a border or a corner with `cell`.
  std::vector<int> neighbours(int cell) const;

 private:
  int columns(int ring) const { return first_[ring + 1] - first_[ring]; }
  int ring_of(int cell) const;
  void add_overlapping(int ring, double from, double to, std::vector<int>& cells) const;

  int rings_;
  std::vector<int> first_;  // first cell of each ring; the number of cells at the end
};

}  // namespace catchlight::render
