#include "tracking/detection/families.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>

#include "catchlight/error.hpp"

namespace catchlight::tracking {
namespace {

struct Family {
  const char* name;
  apriltag_family* (*create)();
  void (*destroy)(apriltag_family*);
};

constexpr Family kFamilies[] = {
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
};

/// The closed ring of cells `outset` cells outside the detected square (-1: the first ring inside it).
void fill_ring(TagLayout& layout, int outset, Ink ink) {
  const int first = -outset, last = layout.cells_across - 1 + outset;
  for (int row = first; row <= last; ++row)
    for (int column = first; column <= last; ++column)
      if (row == first || row == last || column == first || column == last)
        layout.cells[static_cast<std::size_t>((row + layout.margin) * layout.side() + column + layout.margin)] = ink;
}

}  // namespace

const std::vector<std::string>& tag_families() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Family& family : kFamilies) all.emplace_back(family.name);
    return all;
  }();
  return names;
}

FamilyPtr create_family(const std::string& name) {
  for (const Family& family : kFamilies)
    if (name == family.name) return {family.create(), family.destroy};
  std::string known;
  for (const Family& family : kFamilies) known += std::string(known.empty() ? "" : ", ") + family.name;
  throw Error("tag family '" + name + "' is not known; use one of " + known);
}

TagLayout tag_layout(const std::string& family_name, int id) {
  const FamilyPtr family = create_family(family_name);
  if (id < 0 || static_cast<std::uint32_t>(id) >= family->ncodes)
    throw Error("tag id " + std::to_string(id) + " does not exist in " + family_name + "; its ids are 0 to " +
                std::to_string(family->ncodes - 1));

  TagLayout layout;
  layout.cells_across = family->width_at_border;
  layout.margin = (family->total_width - family->width_at_border) / 2;
  layout.white_inside = family->reversed_border;
  layout.cells.assign(static_cast<std::size_t>(layout.side() * layout.side()), Ink::unknown);
  fill_ring(layout, 0, layout.white_inside ? Ink::white : Ink::black);
  fill_ring(layout, 1, layout.white_inside ? Ink::black : Ink::white);
  const std::uint64_t code = family->codes[id];
  for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
    const bool is_white = code >> (family->nbits - 1 - bit) & 1;
    const int column = static_cast<int>(family->bit_x[bit]) + layout.margin;
    const int row = static_cast<int>(family->bit_y[bit]) + layout.margin;
    layout.cells[static_cast<std::size_t>(row * layout.side() + column)] = is_white ? Ink::white : Ink::black;
  }
  return layout;
}

}  // namespace catchlight::tracking
