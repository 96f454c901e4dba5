#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/support/output_file.hpp"
#include "app/tools/tag_print/writers.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

struct Options {
  TagGrid grid;
  std::string output, ids, board, paper = "a4";
  double dpi = 300;
  bool overwrite = false;
};

std::string extension_of(const std::string& path) {
  for (const char* extension : {".pdf", ".svg", ".png"})
    if (path.ends_with(extension)) return extension;
  throw UsageError(path + ": expected a name that ends in .pdf, .svg or .png");
}

/// Ids [first, end) of "A:B".
std::pair<int, int> id_range(const std::string& text) {
  const std::vector<std::string> fields = split(text, ':');
  if (fields.size() == 2) {
    const auto first = integer_from_text(fields[0]), end = integer_from_text(fields[1]);
    constexpr std::int64_t kBeyondAllFamilies = 1 << 20;
    if (first && end && *first >= 0 && *first < *end && *end < kBeyondAllFamilies)
      return {static_cast<int>(*first), static_cast<int>(*end)};
  }
  throw UsageError("--ids is " + text + "; expected A:B, such as 0:12 for the ids 0 to 11");
}

/// What goes on each page: the board, or one tag each.
std::vector<TagGrid> grids_of(const Options& options, bool has_spacing) {
  TagGrid grid = options.grid;
  int end_id = grid.first_id + 1;
  if (!options.ids.empty()) std::tie(grid.first_id, end_id) = id_range(options.ids);
  std::vector<TagGrid> grids;
  if (options.board.empty()) {
    for (int id = grid.first_id; id < end_id; ++id) {
      grids.push_back(grid);
      grids.back().first_id = id;
    }
    return grids;
  }
  const glm::ivec2 shape = columns_and_rows(options.board, "--board");
  grid.columns = shape.x;
  grid.rows = shape.y;
  if (!has_spacing && grid.count() > 1) throw UsageError("--board needs --spacing-m, the distance between the tags' centres");
  if (!options.ids.empty() && end_id - grid.first_id != grid.count())
    throw UsageError("--ids " + options.ids + " are " + std::to_string(end_id - grid.first_id) + " tags, but --board " +
                     options.board + " has room for " + std::to_string(grid.count()));
  return {grid};
}

std::string sizes_text(const TagGrid& grid) {
  std::string text = "size_m = " + metres_text(grid.size_m);
  if (grid.count() > 1) text += ", spacing_m = " + metres_text(grid.spacing_m);
  return text;
}

void write_png(const Options& options, TagGrid& grid, Log& log) {
  const PixelGrid pixels = on_pixels(grid, options.dpi);
  grid = pixels.grid;
  const Page page = lay_out(grid, options.paper, 1000.0 / pixels.pixels_per_m);
  write_text_file(options.output, png_bytes(page, pixels.pixels_per_m), options.overwrite);
  const double dpi = std::round(pixels.pixels_per_m * 2.54) / 100;
  log.info("each cell is " + std::to_string(pixels.pixels_per_cell) + " pixels; print at " + plain_text(dpi) + " dpi");
}

void print_tags(const Options& options, bool has_spacing, Log& log) {
  const std::string extension = extension_of(options.output);
  check_output_path(options.output, options.overwrite);
  std::vector<TagGrid> grids = grids_of(options, has_spacing);
  for (const TagGrid& grid : grids) check_tag_grid(grid);
  if (grids.size() > 1 && extension != ".pdf")
    throw UsageError(options.output + ": holds one page, but --ids " + options.ids +
                     " makes one of each tag; write a .pdf, or say --board");
  if (extension == ".png") {
    write_png(options, grids.front(), log);
  } else {
    std::vector<Page> pages;
    for (const TagGrid& grid : grids) pages.push_back(lay_out(grid, options.paper));
    write_text_file(options.output, extension == ".pdf" ? pdf_text(pages) : svg_text(pages.front()), options.overwrite);
  }
  log.info(options.output + ": " + sizes_text(grids.front()) + "; print at 100 % and check the ruler");
  if (grids.size() == 1) std::fputs(scene_toml(grids.front()).c_str(), stdout);
}

}  // namespace

void set_up_tag(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  command.footer("Prints to stdout what scene.toml says about the tag or board.");
  command.add_option("-o,--output", options->output, "FILE.pdf, FILE.svg or FILE.png")->required();
  command.add_option("--family", options->grid.family, "tag family")->capture_default_str();
  CLI::Option* id = command.add_option("--id", options->grid.first_id, "the tag's id; a board's first")->capture_default_str();
  command.add_option("--ids", options->ids, "ids A:B, B left out: one page each in a PDF, or a board's")->excludes(id);
  command.add_option("--size-m", options->grid.size_m, "side of the square that detectors return, metres")->capture_default_str();
  command.add_option("--board", options->board, "COLUMNSxROWS tags, ids row by row from the top left");
  CLI::Option* spacing =
      command.add_option("--spacing-m", options->grid.spacing_m, "from centre to centre of a board's tags, metres");
  command.add_option("--paper", options->paper, "a4, a3, letter, or fit: as large as the print")->capture_default_str();
  command.add_option("--dpi", options->dpi, "resolution of PNG, rounded to whole pixels a cell")
      ->check(CLI::Range(10.0, 4800.0))
      ->capture_default_str();
  command.add_flag("-y,--overwrite", options->overwrite, "replace an existing output");
  show_examples(command, {"catchlight tag --id 12 --size-m 0.14 -o tag.pdf",
                          "catchlight tag --board 4x3 --size-m 0.04 --spacing-m 0.05 -o board.pdf"});
  command.callback([options, spacing, &context] { print_tags(*options, spacing->count() > 0, context.log); });
}

}  // namespace catchlight::app
