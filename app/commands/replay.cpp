#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/support/output_file.hpp"
#include "app/tools/replay/replay.hpp"

namespace catchlight::app {

namespace fs = std::filesystem;

namespace {

struct Options {
  std::string location, sheets = "out/replay";
  RecordingOverrides overrides;
  bool bless = false, both_draw = false;
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

void print_row(const ReplayResult& result, const char* verdict) {
  const PoseComparison pose = result.pose.value_or(PoseComparison{});
  std::printf("%-10s %4d/%-3d %7.3f %7.3f %7.3f %7.3f", result.name.c_str(), pose.tracked, pose.frames, pose.corner_rms_px,
              pose.corner_p95_px, pose.translation_median_mm, pose.rotation_median_deg);
  for (const auto region : {&TruthComparison::mask, &TruthComparison::shadow, &TruthComparison::elsewhere})
    print_pictures(result.pictures, region);
  std::printf(" | %s\n", verdict);
}

void print_renderers(const ReplayResult& result) {
  if (!result.renderers) return;
  const auto& [frames, worst, frame_of_mean, frame_of_p99] = *result.renderers;
  std::printf(
      "%-10s cpu and gl differ by at most %.3f (mean, frame %lld) and %.3f (99th percentile, frame %lld) of 255 in %d frames\n",
      result.name.c_str(), worst.mean, static_cast<long long>(frame_of_mean), worst.p99, static_cast<long long>(frame_of_p99),
      frames);
}

/// The lines that say what drifted; empty where nothing did or it was blessed.
std::vector<std::string> check(const ReplayResult& result, const std::string& expected_path, bool bless) {
  if (bless) {
    write_expected(expected_path, result.figures);
    return {};
  }
  if (!fs::exists(expected_path)) return {expected_path + " is missing; look at the sheet, then run with --bless"};
  return drift(result.figures, read_expected(expected_path));
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

void check_outputs(const Options& options, const std::vector<std::string>& folders) {
  make_output_folder(options.sheets);
  for (const std::string& folder : folders) {
    check_output_path(sheet_path(options, folder), true);
    if (options.bless) check_output_path(expected_path(folder), true);
  }
}

void replay(const Options& options, Context& context) {
  const std::vector<std::string> folders = find_recordings(options.location);
  check_outputs(options, folders);
  std::vector<std::string> drifted, apart;
  std::vector<std::pair<ReplayResult, const char*>> rows;
  for (const std::string& folder : folders) {
    const ReplayResult result =
        replay_recording(folder, options.overrides, options.both_draw, sheet_path(options, folder), context.log);
    const std::vector<std::string> lines = check(result, expected_path(folder), options.bless);
    for (const std::string& line : lines) drifted.push_back(name_of(folder) + ": " + line);
    if (result.renderers)
      for (const std::string& line : drift(*result.renderers)) apart.push_back(name_of(folder) + ": " + line);
    rows.emplace_back(result, options.bless ? "blessed" : lines.empty() ? "as expected" : "DRIFTED");
  }
  print_header();
  for (const auto& [result, verdict] : rows) print_row(result, verdict);
  for (const auto& [result, verdict] : rows) print_renderers(result);
  std::printf("Errors of 255 against the truth; sheets plate | ours | truth | difference x 8 in %s\n", options.sheets.c_str());
  for (const std::string& line : apart) context.log.error(line);
  if (!apart.empty()) context.exit_code = 1;
  if (drifted.empty()) return;
  for (const std::string& line : drifted) context.log.error(line);
  if (!options.bless)
    context.log.error("if the sheets in " + options.sheets + " show that this is right, run the same with --bless");
  context.exit_code = 1;
}

}  // namespace

void set_up_replay(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->location, options->overrides);
  add_renderer_options(command, options->overrides, &options->both_draw);
  command.add_option("-o,--output", options->sheets, "folder for the sheets")->capture_default_str();
  command.add_flag("--bless", options->bless, "write what is measured to each recording's expected.toml");
  show_examples(command, {"catchlight replay recordings/", "catchlight replay recordings/matte --renderer both -o sheets"});
  command.callback([options, &context] { replay(*options, context); });
}

}  // namespace catchlight::app
