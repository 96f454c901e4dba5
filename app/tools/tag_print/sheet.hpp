// Lays tags out on paper, with a ruler and a line that says what they are. Lengths in mm from the page's top left, y down.
#pragma once

#include <string>
#include <vector>

#include "app/support/lettering.hpp"
#include "app/tools/tag_print/tag_grid.hpp"

namespace catchlight::app {

struct RectangleMm {
  double x = 0, y = 0, width = 0, height = 0;
};

/// Black rectangles that do not overlap; those of one tag are one shape, so that renderers leave no seams between them.
using ShapeMm = std::vector<RectangleMm>;

struct TextMm {
  double x = 0, baseline_y = 0;
  std::string text;
};

constexpr double kCapitalMm = 2;  ///< height of capitals
constexpr double kPenMm = 0.25;

struct Page {
  double width_mm = 0, height_mm = 0;
  std::vector<ShapeMm> shapes;
  std::vector<TextMm> texts;
  std::vector<PenLine> lines = {};  ///< drawn by a pen of kPenMm
};

/// All that the pen draws: the page's lines and its lettering.
std::vector<PenLine> pen_lines(const Page& page);

struct Paper {
  std::string name;  ///< "a4", "a3", "letter", or "fit": as large as what is on it
};

/// The names that `--paper` knows.
std::vector<std::string> paper_names();

/// One page with the grid in its middle, upright unless it fits only lengthwise. `pixel_mm` above 0 puts tags on whole multiples
/// of it; cells and spacing have to be multiples already. Throws UsageError where it does not fit, saying what would.
Page lay_out(const TagGrid& grid, const std::string& paper, double pixel_mm = 0);

}  // namespace catchlight::app
