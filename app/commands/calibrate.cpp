#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/media/read/picture_list.hpp"
#include "app/support/output_file.hpp"
#include "app/tools/calibration/collect.hpp"
#include "app/tools/calibration/from_tag.hpp"
#include "app/tools/calibration/report.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {
namespace {

struct Options {
  std::vector<std::string> footage;
  std::string output, picture, checkerboard, tags, frames, model = "standard";
  TagGrid grid;
  double square_m = 0;
  std::optional<int> from_tag;
  bool overwrite = false;
};

/// Which of the options that have no default were given.
struct Given {
  bool square = false, size = false, spacing = false;
};

std::unique_ptr<CalibrationBoard> checkerboard_of(const Options& options, const Given& given) {
  const glm::ivec2 corners = columns_and_rows(options.checkerboard, "--checkerboard");
  if (std::min(corners.x, corners.y) < 3)
    throw UsageError("--checkerboard is " + options.checkerboard +
                     "; expected the corners where four squares meet, at least 3x3 (a board of 10x7 squares is 9x6)");
  if (!given.square) throw UsageError("--checkerboard needs --square-m, the side of a square in metres");
  check_length(options.square_m, "--square-m");
  return make_checkerboard(corners, options.square_m);
}

std::unique_ptr<CalibrationBoard> tag_board_of(const Options& options, const Given& given) {
  TagGrid grid = options.grid;
  const glm::ivec2 shape = columns_and_rows(options.tags, "--tags");
  grid.columns = shape.x;
  grid.rows = shape.y;
  constexpr int kMinTags = 4;
  if (grid.count() < kMinTags)
    throw UsageError("--tags is " + options.tags +
                     ", too few for a calibration; print a board with `catchlight tag --board 4x3`");
  if (!given.size) throw UsageError("--tags needs --size-m, the side of the square that detectors return, in metres");
  if (!given.spacing) throw UsageError("--tags needs --spacing-m, the distance between the tags' centres in metres");
  check_tag_grid(grid);
  return make_tag_board(grid);
}

std::unique_ptr<CalibrationBoard> board_of(const Options& options, const Given& given) {
  if (options.checkerboard.empty() == options.tags.empty())
    throw UsageError(
        "say which board is in the footage: --checkerboard 9x6 --square-m 0.025, or --tags 4x3 --size-m 0.04 --spacing-m 0.05; "
        "or --from-tag 0 for a first guess by the shot's own tag");
  return options.tags.empty() ? checkerboard_of(options, given) : tag_board_of(options, given);
}

LensModel lens_model(const std::string& name) {
  return name == "plain" ? LensModel::plain : name == "rational" ? LensModel::rational : LensModel::standard;
}

std::string numbers_text(const std::vector<std::int64_t>& numbers) {
  std::string text;
  for (const std::int64_t number : numbers) text += (text.empty() ? "" : ", ") + std::to_string(number);
  return text;
}

std::unique_ptr<MediaSource> open_calibration_footage(const Options& options) {
  std::unique_ptr<MediaSource> source = open_footage_or_pictures(options.footage);
  if (source->info().is_one_pass && !source->info().is_live)
    throw UsageError(options.footage.front() + ": is looked at twice, and can be read once; give a file");
  if (source->info().is_live && parse_frame_range(options.frames).end == FrameRange{}.end)
    throw UsageError(options.footage.front() + ": has no end; say how many frames to look at, such as --frames 0:900");
  return source;
}

CollectedViews views_in(const Options& options, CalibrationBoard& board, Log& log) {
  const FrameRange range = parse_frame_range(options.frames);
  const std::unique_ptr<MediaSource> source = open_calibration_footage(options);
  const std::string& name = options.footage.front();
  CollectedViews views = collect_views(*source, board, range, log);
  if (views.damage) log.warn(*views.damage + "; calibrating with what was read before");
  if (views.frames_with_board == 0)
    throw Error(name + ": the board was found in none of " + counted(views.frames_tried, "frame") +
                "; is it described as it is (" +
                (options.tags.empty() ? "inner corners, not squares; all of them in the picture, with white around"
                                      : "family, ids, columns and rows; four tags or more in the picture") +
                "), sharp and evenly lit?");
  log.info("board seen in " + std::to_string(views.frames_with_board) + " of " + counted(views.frames_tried, "frame") +
           " tried, of " + std::to_string(views.frames_read));
  if (!views.blurred.empty()) log.info("left out as blurred: frame " + numbers_text(views.blurred));
  return views;
}

std::vector<BoardView> board_views(const CollectedViews& collected) {
  std::vector<BoardView> views;
  for (const SeenBoard& board : collected.boards) views.push_back(board.view);
  return views;
}

/// The same frames measured again, by the camera model that their first measures gave.
std::vector<BoardView> measured_again(const CollectedViews& collected, CalibrationBoard& board, const CameraModel& camera) {
  std::vector<BoardView> views;
  for (const SeenBoard& seen : collected.boards)
    if (auto view = board.find(seen.frame.luma(), camera)) {
      view->frame = seen.view.frame;
      views.push_back(std::move(*view));
    }
  return views;
}

void write_picture(const std::string& path, const Calibration& calibration, bool overwrite) {
  const std::vector<std::uint8_t> png = render::encode_png(calibration_picture(calibration));
  write_text_file(path, {reinterpret_cast<const char*>(png.data()), png.size()}, overwrite);
}

/// A board is better in every respect but one: the footage may show the shot's own tag alone.
void calibrate_from_tag(const Options& options, const Given& given, Log& log) {
  if (!options.checkerboard.empty() || !options.tags.empty() || given.square || given.size || given.spacing ||
      !options.picture.empty())
    throw UsageError("--from-tag takes the tag's id, and --family, and no options of boards");
  const auto source = open_calibration_footage(options);
  const CameraFromTag result = camera_from_tag(*source, options.footage.front(), options.grid.family, *options.from_tag,
                                               parse_frame_range(options.frames), log);
  write_text_file(options.output, camera_text(result.camera, options.output), options.overwrite);
  std::fputs(camera_from_tag_text(result).c_str(), stdout);
}

void calibrate(const Options& options, const Given& given, Log& log) {
  check_camera_format(options.output);
  check_output_path(options.output, options.overwrite);
  if (!options.picture.empty()) check_output_path(options.picture, options.overwrite);
  if (!options.picture.empty() && !options.picture.ends_with(".png"))
    throw UsageError(options.picture + ": expected a name that ends in .png");
  refuse_shared_files({options.output, options.picture}, options.footage);
  if (options.from_tag) return calibrate_from_tag(options, given, log);
  const std::unique_ptr<CalibrationBoard> board = board_of(options, given);
  const LensModel most = lens_model(options.model);
  const CollectedViews collected = views_in(options, *board, log);
  Calibration calibration = solve_camera(board_views(collected), collected.width_px, collected.height_px, most);
  if (board->needs_camera())
    calibration =
        solve_camera(measured_again(collected, *board, calibration.camera), collected.width_px, collected.height_px, most);

  write_text_file(options.output, camera_text(calibration, options.output), options.overwrite);
  if (!options.picture.empty()) write_picture(options.picture, calibration, options.overwrite);
  std::fputs(calibration_text(calibration).c_str(), stdout);
  for (const std::string& hint : calibration_hints(calibration, most)) log.warn(hint);
}

}  // namespace

void set_up_calibrate(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  command.footer("docs/calibration.md says how to film the board.");
  command
      .add_option("FOOTAGE", options->footage,
                  "a video, a %04d pattern, or pictures (names or a glob) that show the board from many sides")
      ->required();
  command.add_option("-o,--output", options->output, "camera file: .yaml, .json or .xml, OpenCV's own")->required();
  command.add_option("--checkerboard", options->checkerboard, "COLUMNSxROWS of corners where four squares meet");
  CLI::Option* square = command.add_option("--square-m", options->square_m, "side of a square of the checkerboard, metres");
  command.add_option("--tags", options->tags, "COLUMNSxROWS of tags, ids row by row from the top left, as `tag --board` prints");
  command.add_option("--family", options->grid.family, "tag family")->capture_default_str();
  CLI::Option* size = command.add_option("--size-m", options->grid.size_m, "side of the square that detectors return, metres");
  CLI::Option* spacing = command.add_option("--spacing-m", options->grid.spacing_m, "from centre to centre of the tags, metres");
  command.add_option("--first-id", options->grid.first_id, "the tag at the top left")->capture_default_str();
  command.add_option("--from-tag", options->from_tag,
                     "the focal length alone, from footage of one tag of this id that moves and is tilted");
  command
      .add_option("--model", options->model, "at most: plain (no distortion), standard (k1 k2 p1 p2 k3), rational (and k4 k5 k6)")
      ->check(CLI::IsMember({"plain", "standard", "rational"}))
      ->capture_default_str();
  command.add_option("--frames", options->frames,
                     "only frames A:B, numbered from 0 (image sequences: by their own numbers), B left out");
  command.add_option("--picture", options->picture, "draw where the board was and how far off each corner is, PNG");
  command.add_flag("-y,--overwrite", options->overwrite, "replace existing outputs");
  show_examples(command, {"catchlight calibrate board.mp4 --checkerboard 9x6 --square-m 0.025 -o camera.yaml",
                          "catchlight calibrate board.mp4 --tags 4x3 --size-m 0.04 --spacing-m 0.05 -o camera.yaml"});
  command.callback([=, &context] {
    calibrate(*options, {square->count() > 0, size->count() > 0, spacing->count() > 0}, context.log);
  });
}

}  // namespace catchlight::app
