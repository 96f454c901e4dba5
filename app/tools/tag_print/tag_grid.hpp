// A printed board: tags of one size in rows and columns. `tag` prints it, `calibrate` measures with it.
#pragma once

#include <glm/glm.hpp>
#include <string>

namespace catchlight::app {

/// Ids go row by row from the top left, which is the board's first tag; its frame is the board's frame (x right, y up).
struct TagGrid {
  std::string family = "tag36h11";
  int columns = 1, rows = 1;
  int first_id = 0;
  double size_m = 0.08;    ///< side of the square whose corners detectors return
  double spacing_m = 0.1;  ///< from centre to centre; means nothing for a single tag

  int count() const { return columns * rows; }
  int last_id() const { return first_id + count() - 1; }

  /// Centre of tag `first_id + index` in the frame of the first.
  glm::dvec3 center_m(int index) const;
};

/// Cells from the centre of a tag to the end of what is printed black, and of the white that detection needs around it.
struct TagReach {
  double ink_cells = 0, quiet_cells = 0;
  double cells_across = 0;
};
TagReach tag_reach(const std::string& family);

/// "4x3" as columns and rows. Throws UsageError naming `option`.
glm::ivec2 columns_and_rows(const std::string& text, const std::string& option);

/// Throws UsageError naming `option` for what is no length of a print: below 0.1 mm, above 100 m, no number.
void check_length(double length_m, const std::string& option);

/// Throws Error for a family or ids that do not exist, UsageError for sizes that are none and for tags closer than the white cell
/// that they need between them.
void check_tag_grid(const TagGrid& grid);

/// Metres to a tenth of a micrometre: sums of decimal steps show no binary dust.
std::string metres_text(double length_m);

/// `[tag]` and one `[[tag.bundle]]` for each further tag: what scene.toml says about this board.
std::string scene_toml(const TagGrid& grid);

}  // namespace catchlight::app
