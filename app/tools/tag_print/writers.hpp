// Pages as files that print at their exact size.
#pragma once

#include <string>
#include <vector>

#include "app/tools/tag_print/sheet.hpp"

namespace catchlight::app {

/// PDF 1.4 (ISO 32000-1), one page for each of `pages`: a path for every shape and line of the pen, text to search, and a wish
/// not to be scaled by print dialogues.
std::string pdf_text(const std::vector<Page>& pages);

/// SVG 1.1 whose user unit is 1 mm.
std::string svg_text(const Page& page);

/// Grey PNG whose pHYs chunk states `pixels_per_m`. Rectangles end at whole pixels. Throws UsageError for a picture larger than
/// 2^30 pixels or 65535 on a side.
std::string png_bytes(const Page& page, int pixels_per_m);

/// The grid as whole pixels can show it.
struct PixelGrid {
  TagGrid grid;  ///< its true sizes: cells and spacing are whole pixels
  int pixels_per_m = 0;
  int pixels_per_cell = 0;
};

/// The nearest whole number of pixels a cell to `dpi`; then the resolution is adapted, so that the size stays what was asked for
/// but for the whole number of pixels per metre that PNG can state. Throws UsageError where a cell is less than one pixel.
PixelGrid on_pixels(const TagGrid& grid, double dpi);

}  // namespace catchlight::app
