#include "app/tools/tag_print/sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::app {
namespace {

constexpr double kMarginMm = 5;  ///< what most printers cannot reach
constexpr double kLineMm = 4;    ///< from baseline to baseline
constexpr double kLongestRulerMm = 100;
constexpr double kFooterWidthMm = 60;  ///< the longest line of text; a ruler of 60 mm
constexpr double kArrowMm = 5.5;
constexpr double kTickWidthMm = 0.15;
constexpr double kRulerGapMm = 0.8;                  ///< between ticks and numbers
constexpr std::array kTickHeightsMm{1.5, 2.5, 4.0};  ///< every 1, 5 and 10 mm
constexpr double kRulerMm = 9;                       ///< height with its numbers and the gap above
constexpr double kFooterMm = kRulerMm + 3 * kLineMm;

struct SizeMm {
  double width = 0, height = 0;
  bool holds(const SizeMm& other) const { return other.width <= width + 1e-6 && other.height <= height + 1e-6; }
};

/// Upright. ISO 216 and ANSI.
const std::vector<std::pair<std::string, SizeMm>>& papers() {
  static const std::vector<std::pair<std::string, SizeMm>> all{
      {"a4", {210, 297}}, {"a3", {297, 420}}, {"letter", {215.9, 279.4}}};
  return all;
}

SizeMm grid_size(const TagGrid& grid) {
  const TagReach reach = tag_reach(grid.family);
  const double tag_mm = 1000 * grid.size_m / reach.cells_across * 2 * reach.quiet_cells;
  return {1000 * grid.spacing_m * (grid.columns - 1) + tag_mm, 1000 * grid.spacing_m * (grid.rows - 1) + tag_mm};
}

/// What a page leaves for tags.
SizeMm room_on(const SizeMm& page) {
  return {page.width - 2 * kMarginMm, page.height - 2 * kMarginMm - kFooterMm};
}

/// The most tags of a row that fit a length; 0 for none.
int most_that_fit(double length_mm, double tag_mm, double spacing_mm) {
  return length_mm < tag_mm ? 0 : 1 + static_cast<int>((length_mm - tag_mm) / spacing_mm + 1e-9);
}

std::string what_would_fit(const TagGrid& grid, const SizeMm& room) {
  const SizeMm tag = grid_size({grid.family, 1, 1, grid.first_id, grid.size_m, grid.spacing_m});
  if (grid.count() > 1) {
    const int columns = most_that_fit(room.width, tag.width, 1000 * grid.spacing_m);
    const int rows = most_that_fit(room.height, tag.height, 1000 * grid.spacing_m);
    if (columns > 0 && rows > 0) return "a board of " + std::to_string(columns) + "x" + std::to_string(rows) + " fits";
  }
  const double largest_m = std::floor(1000 * grid.size_m * std::min(room.width, room.height) / tag.width) / 1000;
  return "a single tag fits up to --size-m " + plain_text(largest_m);
}

/// The tag's axes as it is read, with the light probe's directions for a tag that lies flat (docs/conventions.md).
const std::string kUpLabel = "up +y (flat: probe -z)", kRightLabel = "+x (probe +x)";

std::vector<std::string> footer_lines(const TagGrid& grid, int ruler_mm) {
  std::string what = grid.family, sizes = "size_m = " + metres_text(grid.size_m);
  if (grid.count() == 1) {
    what += ", id " + std::to_string(grid.first_id);
  } else {
    what += ", ids " + std::to_string(grid.first_id) + " to " + std::to_string(grid.last_id()) + ", " +
            std::to_string(grid.columns) + "x" + std::to_string(grid.rows);
    sizes += ", spacing_m = " + metres_text(grid.spacing_m);
  }
  return {what, sizes, "print at 100 %; the ruler is " + std::to_string(ruler_mm) + " mm long"};
}

constexpr double kBeforeAxesMm = 4;

/// From the footer's left to the axes: behind the two lines beside them.
double axes_left_mm(const std::vector<std::string>& lines) {
  return kCapitalMm * std::max(lettering_width(lines[0]), lettering_width(lines[1])) + kBeforeAxesMm;
}

double footer_width_mm(const TagGrid& grid) {
  const double axes_mm =
      std::max(lettering_width(kUpLabel) * kCapitalMm, kArrowMm + lettering_width(kRightLabel) * kCapitalMm) + 1.5;
  return std::max(kFooterWidthMm, axes_left_mm(footer_lines(grid, 0)) + axes_mm);
}

SizeMm page_for(const TagGrid& grid, const std::string& paper) {
  const SizeMm content = grid_size(grid);
  if (paper == "fit")
    return {std::max(content.width, footer_width_mm(grid)) + 2 * kMarginMm, content.height + 2 * kMarginMm + kFooterMm};
  const auto found = std::find_if(papers().begin(), papers().end(), [&](const auto& known) { return known.first == paper; });
  if (found == papers().end()) throw UsageError("--paper is \"" + paper + "\"; expected " + quoted_list(paper_names()));
  const SizeMm upright = found->second, lengthwise{upright.height, upright.width};
  for (const SizeMm& page : {upright, lengthwise})
    if (room_on(page).holds(content)) return page;
  const auto rounded = [](double mm) { return plain_text(std::ceil(mm)); };
  throw UsageError("the print with its white margin is " + rounded(content.width) + " x " + rounded(content.height) +
                   " mm, which " + paper + " has no room for; " + what_would_fit(grid, room_on(upright)) +
                   " (or take a larger --paper, or fit)");
}

/// Black runs of one tag, whose square has its top left at (left_mm, top_mm).
ShapeMm tag_shape(const std::string& family, int id, double left_mm, double top_mm, double cell_mm) {
  const tracking::TagLayout layout = tracking::tag_layout(family, id);
  ShapeMm shape;
  const int first = -layout.margin, end = layout.cells_across + layout.margin;
  for (int row = first; row < end; ++row)
    for (int column = first; column < end; ++column) {
      const int start = column;
      while (column < end && layout.at(column, row) == tracking::Ink::black) ++column;
      if (column > start)
        shape.push_back({left_mm + start * cell_mm, top_mm + row * cell_mm, (column - start) * cell_mm, cell_mm});
    }
  return shape;
}

void add_ruler(Page& page, double left_mm, double top_mm, int length_mm) {
  ShapeMm ticks;
  for (int mm = 0; mm <= length_mm; ++mm) {
    const std::size_t kind = mm % 10 == 0 ? 2 : mm % 5 == 0 ? 1 : 0;
    ticks.push_back({left_mm + mm - kTickWidthMm / 2, top_mm, kTickWidthMm, kTickHeightsMm[kind]});
    if (kind != 2) continue;
    const std::string number = std::to_string(mm);
    page.texts.push_back(
        {left_mm + mm - kCapitalMm * lettering_width(number) / 2, top_mm + kTickHeightsMm[2] + kRulerGapMm + kCapitalMm, number});
  }
  page.shapes.push_back(ticks);
}

void add_axes(Page& page, double left_mm, double baseline_mm) {
  constexpr double kHeadMm = 1.2, kLabelGapMm = 1.5;
  const glm::dvec2 origin(left_mm, baseline_mm);
  for (const glm::dvec2& along : {glm::dvec2(0, -1), glm::dvec2(1, 0)}) {
    const glm::dvec2 tip = origin + kArrowMm * along, back = tip - kHeadMm * along,
                     aside = 0.6 * kHeadMm * glm::dvec2(along.y, along.x);
    page.lines.push_back({origin, tip});
    page.lines.push_back({back + aside, tip, back - aside});
  }
  page.texts.push_back({left_mm + kLabelGapMm, baseline_mm - kArrowMm + kCapitalMm, kUpLabel});
  page.texts.push_back({left_mm + kArrowMm + kLabelGapMm, baseline_mm + kCapitalMm / 2, kRightLabel});
}

}  // namespace

std::vector<PenLine> pen_lines(const Page& page) {
  std::vector<PenLine> lines = page.lines;
  for (const TextMm& text : page.texts)
    for (PenLine& line : lettering(text.text)) {
      for (glm::dvec2& point : line) point = glm::dvec2(text.x, text.baseline_y) + kCapitalMm * point;
      lines.push_back(std::move(line));
    }
  return lines;
}

std::vector<std::string> paper_names() {
  std::vector<std::string> names;
  for (const auto& [name, size] : papers()) names.push_back(name);
  names.push_back("fit");
  return names;
}

Page lay_out(const TagGrid& grid, const std::string& paper, double pixel_mm) {
  const SizeMm size = page_for(grid, paper), content = grid_size(grid), room = room_on(size);
  const TagReach reach = tag_reach(grid.family);
  const double cell_mm = 1000 * grid.size_m / reach.cells_across;
  const double quiet_mm = (reach.quiet_cells - reach.cells_across / 2) * cell_mm;
  const auto snapped = [&](double mm) { return pixel_mm > 0 ? std::round(mm / pixel_mm) * pixel_mm : mm; };
  const double left_mm = snapped((size.width - content.width) / 2 + quiet_mm);
  const double top_mm = snapped(kMarginMm + (room.height - content.height) / 2 + quiet_mm);

  Page page{size.width, size.height, {}, {}};
  for (int index = 0; index < grid.count(); ++index) {
    const glm::dvec3 center_m = grid.center_m(index);
    page.shapes.push_back(
        tag_shape(grid.family, grid.first_id + index, left_mm + 1000 * center_m.x, top_mm - 1000 * center_m.y, cell_mm));
  }
  const int ruler_mm = static_cast<int>(std::min(kLongestRulerMm, std::floor(room.width / 10 + 1e-9) * 10));
  const double footer_left_mm = (size.width - ruler_mm) / 2, footer_top_mm = size.height - kMarginMm - kFooterMm;
  add_ruler(page, footer_left_mm, footer_top_mm + 2, ruler_mm);
  double baseline_mm = footer_top_mm + kRulerMm;
  const std::vector<std::string> lines = footer_lines(grid, ruler_mm);
  for (const std::string& line : lines) page.texts.push_back({footer_left_mm, baseline_mm += kLineMm, line});
  add_axes(page, footer_left_mm + axes_left_mm(lines), footer_top_mm + kRulerMm + 2 * kLineMm - kCapitalMm / 4);
  return page;
}

}  // namespace catchlight::app
