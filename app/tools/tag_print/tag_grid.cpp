#include "app/tools/tag_print/tag_grid.hpp"

#include <cmath>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::app {
namespace {

constexpr int kMaxAcross = 100;  ///< a board's columns, and its rows
constexpr double kMinLength_m = 1e-4, kMaxLength_m = 100;

}  // namespace

std::string metres_text(double length_m) {
  const double rounded = std::round(length_m * 1e7) / 1e7;
  return plain_text(rounded == 0 ? 0 : rounded);
}

glm::dvec3 TagGrid::center_m(int index) const {
  return {spacing_m * (index % columns), -spacing_m * (index / columns), 0};
}

TagReach tag_reach(const std::string& family) {
  const tracking::TagLayout layout = tracking::tag_layout(family, 0);
  // Where the border's inside is white, the ring around it is black and bits may follow; else that ring is the white margin.
  const double ink_cells = layout.cells_across / 2.0 + (layout.white_inside ? layout.margin : 0);
  return {ink_cells, ink_cells + 1, static_cast<double>(layout.cells_across)};
}

glm::ivec2 columns_and_rows(const std::string& text, const std::string& option) {
  const std::vector<std::string> fields = split(text, 'x');
  const auto number = [&](std::size_t i) { return integer_from_text(fields[i]).value_or(0); };
  if (fields.size() == 2 && std::min(number(0), number(1)) >= 1 && std::max(number(0), number(1)) <= kMaxAcross)
    return {number(0), number(1)};
  throw UsageError(option + " is " + text + "; expected columns x rows, such as 4x3, each from 1 to " +
                   std::to_string(kMaxAcross));
}

void check_length(double length_m, const std::string& option) {
  if (length_m >= kMinLength_m && length_m <= kMaxLength_m) return;
  throw UsageError(option + " is " + plain_text(length_m) + "; expected metres, from " + plain_text(kMinLength_m) + " to " +
                   plain_text(kMaxLength_m));
}

void check_tag_grid(const TagGrid& grid) {
  check_length(grid.size_m, "--size-m");
  tracking::tag_layout(grid.family, grid.first_id);
  tracking::tag_layout(grid.family, grid.last_id());
  if (grid.count() == 1) return;
  check_length(grid.spacing_m, "--spacing-m");
  const TagReach reach = tag_reach(grid.family);
  const double least_m = grid.size_m / reach.cells_across * (2 * reach.ink_cells + 1);
  if (grid.spacing_m < least_m * (1 - 1e-9))
    throw UsageError("--spacing-m is " + plain_text(grid.spacing_m) + ", from centre to centre; " + grid.family + " of " +
                     plain_text(grid.size_m) + " m with one white cell between tags needs " + metres_text(least_m) + " or more");
}

std::string scene_toml(const TagGrid& grid) {
  std::string text = "[tag]\nfamily = \"" + grid.family + "\"\nid = " + std::to_string(grid.first_id) +
                     "\nsize_m = " + metres_text(grid.size_m) + "\n";
  for (int index = 1; index < grid.count(); ++index) {
    const glm::dvec3 center_m = grid.center_m(index);
    text += "\n[[tag.bundle]]\nid = " + std::to_string(grid.first_id + index) + "\ntag_from_this = { translation_m = [" +
            metres_text(center_m.x) + ", " + metres_text(center_m.y) + ", 0] }\n";
  }
  return text;
}

}  // namespace catchlight::app
