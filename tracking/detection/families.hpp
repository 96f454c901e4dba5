// The AprilTag library's families, and which cells of a tag are printed white and black.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct apriltag_family;

namespace catchlight::tracking {

/// Every family the AprilTag library has, by the names it is known by.
const std::vector<std::string>& tag_families();

using FamilyPtr = std::unique_ptr<apriltag_family, void (*)(apriltag_family*)>;

/// Throws Error naming the families there are.
FamilyPtr create_family(const std::string& name);

enum class Ink : std::uint8_t { unknown, white, black };

/// One tag's print. Cell (0, 0) is the first one inside the square that detectors return, at the top left as the tag is
/// read; columns go right, rows go down; cells outside the square have negative indices or ones from `cells_across` on.
struct TagLayout {
  int cells_across = 0;       ///< cells along a side of the detected square
  int margin = 0;             ///< known cells around that square: data or border
  bool white_inside = false;  ///< the ring just inside the square is white, the one just outside black
  std::vector<Ink> cells;     ///< row-major, side() x side()

  int side() const { return cells_across + 2 * margin; }
  Ink at(int column, int row) const { return cells[static_cast<std::size_t>((row + margin) * side() + column + margin)]; }
};

/// Throws Error for a family or id that does not exist, naming what there is.
TagLayout tag_layout(const std::string& family, int id);

}  // namespace catchlight::tracking
