#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/support/output_file.hpp"
#include "app/tools/replay/replay.hpp"
#include "app/tools/replay/replay_report.hpp"

namespace catchlight::app {

namespace fs = std::filesystem;

namespace {

struct Options {
  std::string location, sheets = "out/replay", report;
  RecordingOverrides overrides;
  bool bless = false, both_draw = false, overwrite = false;
};

void print_header() {
  std::printf("%-10s %8s %15s %7s %7s | %-25s | %-25s | %-25s | %s\n", "recording", "tracked", "corner px", "mm", "deg",
              "mask mean p95 PSNR SSIM", "shadow", "elsewhere", "verdict");
}

/// Dashes where the recording has no truth to look at.
void print_pictures(const std::optional<TruthComparison>& pictures, PictureError TruthComparison::*region) {
  if (!pictures) {
    std::printf(" | %5s %5s %5s %6s ", "-", "-", "-", "-");
    return;
  }
  const PictureError& error = (*pictures).*region;
  std::printf(" | %5.2f %5.2f %5.1f %6.4f ", error.mean, error.p95, error.psnr_db, error.ssim);
}

void print_row(const ReplayResult& result, const std::string& verdict) {
  const PoseComparison pose = result.pose.value_or(PoseComparison{});
  std::printf("%-10s %4d/%-3d %7.3f %7.3f %7.3f %7.3f", result.name.c_str(), pose.tracked, pose.frames, pose.corner_rms_px,
              pose.corner_p95_px, pose.translation_median_mm, pose.rotation_median_deg);
  for (const auto region : {&TruthComparison::mask, &TruthComparison::shadow, &TruthComparison::elsewhere})
    print_pictures(result.pictures, region);
  std::printf(" | %s\n", verdict.c_str());
}

void print_renderers(const ReplayResult& result) {
  if (!result.renderers) return;
  const auto& [frames, worst, frame_of_mean, frame_of_p99] = *result.renderers;
  std::printf(
      "%-10s cpu and gl differ by at most %.3f (mean, frame %lld) and %.3f (99th percentile, frame %lld) of 255 in %d frames\n",
      result.name.c_str(), worst.mean, static_cast<long long>(frame_of_mean), worst.p99, static_cast<long long>(frame_of_p99),
      frames);
}

void print_kept(const ReplayResult& result) {
  if (!result.kept) return;
  std::printf(
      "%-10s differs from its baseline by at most %.2f (mean) and %.0f (99th percentile) of 255, where either changes the plate,"
      " in %d of its frames; corners, mm and deg are against the kept track\n",
      result.name.c_str(), result.kept->worst.mean, result.kept->worst.p99, result.kept->frames);
}

/// Where the sheets are, and which recordings have none.
void print_sheets(const std::vector<Replayed>& recordings, const std::string& folder) {
  std::string with, without;
  for (const Replayed& replayed : recordings) {
    std::string& names = replayed.result.has_sheet ? with : without;
    names += (names.empty() ? "" : ", ") + replayed.result.name;
  }
  if (!with.empty())
    std::printf("Sheets plate | ours | truth or baseline | difference x 8 in %s: %s\n", folder.c_str(), with.c_str());
  if (!without.empty()) std::printf("No sheet of %s: there are no pictures to compare with\n", without.c_str());
}

/// The lines that say what drifted; empty where nothing did.
std::vector<std::string> check(const Replayed& replayed, const std::string& expected_path) {
  if (fs::exists(expected_path)) return drift(replayed.result.figures, replayed.expected);
  return {expected_path + " is missing; " + (replayed.result.has_sheet ? "look at " + replayed.sheet + ", then run" : "run") +
          " with --bless"};
}

std::string name_of(const std::string& folder) {
  return fs::canonical(folder).filename().string();  // "matte/" has a name too
}

std::string sheet_path(const Options& options, const std::string& folder) {
  return (fs::path(options.sheets) / (name_of(folder) + ".png")).string();
}

std::string expected_path(const std::string& folder) {
  return (fs::path(folder) / "expected.toml").string();
}

/// What can be refused before the footage is opened.
void check_all(const Options& options, const std::vector<std::string>& folders) {
  if (!options.report.empty()) check_output_path(options.report, options.overwrite);
  make_output_folder(options.sheets);
  for (const std::string& folder : folders) {
    check_output_path(sheet_path(options, folder), true);
    const std::string expected = expected_path(folder);
    if (options.bless)
      check_output_path(expected, true);
    else if (fs::exists(expected))
      read_expected(expected);
  }
  for (const std::string& folder : folders) {
    check_comparable(folder, options.bless);
    refuse_shared_files({options.report}, files_of(open_recording(folder, options.overrides)));
    check_recording(folder, options.overrides);
  }
}

Replayed replay_one(const Options& options, const std::string& folder, Context& context) {
  Replayed replayed;
  replayed.folder = folder;
  replayed.sheet = sheet_path(options, folder);
  replayed.is_blessed = options.bless;
  replayed.result = replay_recording(folder, {options.overrides, options.both_draw, options.bless, replayed.sheet}, context.log);
  const std::string path = expected_path(folder);
  if (options.bless) write_expected(path, replayed.result.figures);
  if (fs::exists(path)) replayed.expected = read_expected(path);
  replayed.drifted = check(replayed, path);
  if (replayed.result.renderers) replayed.apart = drift(*replayed.result.renderers);
  return replayed;
}

/// What is wrong, a line each.
void print_drift(const std::vector<Replayed>& recordings, Context& context) {
  bool has_drifted = false;
  for (const Replayed& replayed : recordings)
    for (const auto* lines : {&replayed.apart, &replayed.drifted})
      for (const std::string& line : *lines) {
        context.log.error(replayed.result.name + ": " + line);
        context.exit_code = 1;
        has_drifted |= lines == &replayed.drifted;
      }
  if (has_drifted) context.log.error("if that is right, run the same with --bless; sheets, where there are some, show it");
}

void replay(const Options& options, Context& context) {
  const std::vector<std::string> folders = find_recordings(options.location);
  check_all(options, folders);
  std::vector<Replayed> recordings;
  recordings.reserve(folders.size());
  for (const std::string& folder : folders) recordings.push_back(replay_one(options, folder, context));
  print_header();
  for (const Replayed& replayed : recordings)
    print_row(replayed.result, replayed.verdict() == "drifted" ? "DRIFTED" : replayed.verdict());
  for (const Replayed& replayed : recordings) print_renderers(replayed.result);
  for (const Replayed& replayed : recordings) print_kept(replayed.result);
  std::printf("Errors are of 255. ");
  print_sheets(recordings, options.sheets);
  if (!options.report.empty()) write_text_file(options.report, replay_json(recordings), options.overwrite);
  print_drift(recordings, context);
}

}  // namespace

void set_up_replay(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->location, options->overrides);
  add_renderer_options(command, options->overrides, &options->both_draw);
  command.get_option("RECORDING")
      ->description("Folder of a recording, or a folder of such folders; docs/replay.md says what is in them");
  command.add_option("-o,--output", options->sheets, "folder for the sheets, which are written anew")->capture_default_str();
  command.add_option("--report", options->report, "write figures, what was expected of them and verdicts, JSON");
  command.add_flag("-y,--overwrite", options->overwrite, "replace an existing report");
  command.add_flag(
      "--bless", options->bless,
      "write what is measured to each recording's expected.toml; of one without truth keep the track and some frames");
  show_examples(command, {"catchlight replay recordings/", "catchlight replay recordings/matte --renderer both -o sheets"});
  command.callback([options, &context] { replay(*options, context); });
}

}  // namespace catchlight::app
