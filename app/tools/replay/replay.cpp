#include "app/tools/replay/replay.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <set>

#include "app/session/run_stages.hpp"
#include "app/session/scene_files.hpp"
#include "app/support/output_file.hpp"
#include "app/tools/replay/replay_pictures.hpp"
#include "app/tools/replay/sheet.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "render/image/picture_file.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {

namespace fs = std::filesystem;

namespace {

/// The frames of a recording whose truth is known, and how ours differ from it.
class TruthFrames {
 public:
  explicit TruthFrames(std::string folder) : folder_(std::move(folder)) {}

  bool has(std::int64_t number) const { return fs::exists(path("truth", number)); }

  /// Throws Error where a frame has no mask.
  void check_masks() const {
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(folder_) / "truth"))
      if (const auto number = integer_from_text(entry.path().stem().string()); number && has(*number))
        check_exists(path("mask", *number));
  }

  void compare(const FrameJob& job) {
    const cv::Mat ours = composited_bgr(job), plate_bgr = bgr_of(job.image);
    const std::int64_t number = job.image.number();
    const cv::Mat truth = read(path("truth", number), ours.size());
    const fs::path clean_path = path("plate_clean", number);
    const cv::Mat clean = fs::exists(clean_path) ? read(clean_path, ours.size()) : plate_bgr;
    cv::Mat mask = read(path("mask", number), ours.size());
    cv::cvtColor(mask, mask, cv::COLOR_BGR2GRAY);
    comparisons.push_back(compare_with_truth(ours, truth, plate_bgr, clean, mask));
    sheet_rows.push_back(sheet_row(plate_bgr, ours, truth));
  }

  std::vector<TruthComparison> comparisons;
  std::vector<cv::Mat> sheet_rows;

 private:
  fs::path path(const char* kind, std::int64_t number) const {
    char name[32];
    std::snprintf(name, sizeof name, "%04lld.png", static_cast<long long>(number));
    return fs::path(folder_) / kind / name;
  }

  static void check_exists(const fs::path& path) {
    if (!fs::exists(path)) throw Error(path.string() + ": missing; every frame of truth/ needs its mask/");
  }

  static cv::Mat read(const fs::path& path, const cv::Size& size) {
    check_exists(path);
    return read_bgr(path.string(), size);
  }

  std::string folder_;
};

void add_figures(const PoseComparison& pose, std::vector<Figure>& figures) {
  figures.push_back({"pose.tracked_frames", static_cast<double>(pose.tracked), 0});
  figures.push_back({"pose.corner_rms_px", pose.corner_rms_px, 0.003});
  figures.push_back({"pose.corner_p95_px", pose.corner_p95_px, 0.01});
  figures.push_back({"pose.translation_median_mm", pose.translation_median_mm, 0.03});
  figures.push_back({"pose.rotation_median_deg", pose.rotation_median_deg, 0.02});
  figures.push_back({"pose.rotation_max_deg", pose.rotation_max_deg, 0.1});
  figures.push_back({"pose.false_positives", static_cast<double>(pose.false_positives), 0});
  figures.push_back({"pose.flips", static_cast<double>(pose.flips), 0});
}

void add_figures(const std::string& region, const PictureError& error, std::vector<Figure>& figures) {
  figures.push_back({region + ".mean", error.mean, 0.1});
  figures.push_back({region + ".p95", error.p95, 0.3});
  figures.push_back({region + ".psnr_db", error.psnr_db, 0.2});
  figures.push_back({region + ".ssim", error.ssim, 0.002});
}

void add_figures(const TruthComparison& pictures, bool glares, std::vector<Figure>& figures) {
  add_figures("mask", pictures.mask, figures);
  add_figures("shadow", pictures.shadow, figures);
  figures.push_back({"shadow.untouched_mean", pictures.shadow_untouched_mean, 0.1});
  if (glares) {
    add_figures("glare", pictures.glare, figures);
    figures.push_back({"glare.untouched_mean", pictures.glare_untouched_mean, 0.1});
  }
  add_figures("elsewhere", pictures.elsewhere, figures);
  figures.push_back({"elsewhere.changed_mean", pictures.elsewhere_changed_mean, 0.02});
}

void add_figures(const KeptComparison& kept, const std::vector<TrackRow>& rows, std::vector<Figure>& figures) {
  const auto found = std::ranges::count_if(rows, [](const TrackRow& row) { return row.found; });
  figures.push_back({"track.found_frames", static_cast<double>(found), 0});
  figures.push_back({"picture.frames", static_cast<double>(kept.frames), 0});
  figures.push_back({"picture.mean", kept.worst.mean, 0.2});
  figures.push_back({"picture.p99", kept.worst.p99, 2});
}

/// Takes the session through its footage. `compare` sees the frames that `wants` wants; where both renderers draw, they draw all.
void run(Session& session, const ReplayOptions& options, const std::function<bool(const FrameJob&)>& wants,
         const std::function<void(const FrameJob&)>& compare, ReplayResult& result, Log& log) {
  std::optional<RendererComparison> renderers;
  if (options.both_draw) renderers.emplace(session.settings(), session.camera(), log);
  const auto write = [&](const FrameJob& job) {
    if (wants(job)) compare(job);
  };
  const auto look = [&](const FrameJob& job) {
    if (renderers) renderers->compare(job);
  };
  run_stages(session, write, {.wants = [&](const FrameJob& job) { return options.both_draw || wants(job); }, .look = look});
  if (session.damage()) throw Error(*session.damage());
  session.warn_of_track();
  result.name = session.recording().name;
  if (renderers) result.renderers = renderers->difference();
}

void compare_with(const std::vector<TrackRow>& known, const Session& session, ReplayResult& result) {
  result.pose = compare_poses(session.track_rows(), known, session.camera(), session.settings().tag.size_m);
  add_figures(*result.pose, result.figures);
}

ReplayResult replay_truth(Recording recording, const ReplayOptions& options, Log& log) {
  if (!recording.scene.is_by_hand("glare.enabled")) recording.scene.glare.enabled = false;
  recording.scene.lens.noise = Switch::off;
  std::optional<std::vector<TrackRow>> known;  // read before the work, as it may be damaged
  if (recording.poses_csv) known = tracking::read_track_file(*recording.poses_csv).rows;
  Session session(std::move(recording), {.keeps_track = true}, log);
  TruthFrames truth(session.recording().folder);
  ReplayResult result;
  run(
      session, options, [&](const FrameJob& job) { return truth.has(job.image.number()); },
      [&](const FrameJob& job) { truth.compare(job); }, result, log);
  if (known) compare_with(*known, session, result);
  if (!truth.comparisons.empty()) {
    result.pictures = mean_of(truth.comparisons);
    add_figures(*result.pictures, session.settings().glare.enabled, result.figures);
    write_sheet(options.sheet, truth.sheet_rows);
    result.has_sheet = true;
  }
  if (result.figures.empty())
    throw Error(session.recording().folder + ": truth/ has no frame of the footage; expected truth/0000.png, ... with mask/");
  return result;
}

/// Tracks the recording and keeps that. Returns the frames whose pictures are to be kept.
std::set<std::int64_t> keep_track(const Recording& recording, const Baseline& baseline, Log& log) {
  Session session(recording, {.task = "track", .keeps_track = true}, log);
  const std::vector<TrackRow> rows = session.track_range();
  if (session.damage()) throw Error(*session.damage());
  const std::vector<std::int64_t> frames = baseline.keep(rows);
  return {frames.begin(), frames.end()};
}

void keep_picture(const std::string& path, const cv::Mat& picture) {
  PendingFile file = pending_output(path, true);
  render::write_png(file.pending_path(), picture);
  file.commit();
}

ReplayResult replay_baseline(Recording recording, const ReplayOptions& options, Log& log) {
  const Baseline baseline(recording.folder);
  std::set<std::int64_t> kept_anew;
  if (options.bless) kept_anew = keep_track(recording, baseline, log);
  const std::vector<TrackRow> known = tracking::read_track_file(baseline.track_file()).rows;
  Session session(std::move(recording), {.track_file = options.bless ? baseline.track_file() : "", .keeps_track = true}, log);
  ReplayResult result;
  result.kept.emplace();
  std::vector<cv::Mat> sheet;
  const auto wants = [&](const FrameJob& job) {
    const std::int64_t number = job.image.number();
    return options.bless ? kept_anew.contains(number) : baseline.has_picture(number);
  };
  const auto compare = [&](const FrameJob& job) {
    const std::string path = baseline.picture(job.image.number());
    const cv::Mat ours = composited_bgr(job), plate = bgr_of(job.image);
    if (options.bless) keep_picture(path, ours);
    const cv::Mat kept = read_bgr(path, ours.size());
    const KeptDifference apart = compare_with_kept(ours, kept, plate);
    KeptDifference& worst = result.kept->worst;
    worst = {std::max(worst.mean, apart.mean), std::max(worst.p99, apart.p99)};
    ++result.kept->frames;
    sheet.push_back(sheet_row(plate, ours, kept));
  };
  run(session, options, wants, compare, result, log);
  compare_with(known, session, result);
  add_figures(*result.kept, session.track_rows(), result.figures);
  if (!sheet.empty()) write_sheet(options.sheet, sheet);
  result.has_sheet = !sheet.empty();
  return result;
}

}  // namespace

std::vector<std::string> find_recordings(const std::string& location) {
  if (fs::exists(fs::path(location) / "scene.toml")) return {location};
  std::vector<std::string> folders;
  if (fs::is_directory(location))
    for (const fs::directory_entry& entry : fs::directory_iterator(location))
      if (fs::exists(entry.path() / "scene.toml")) folders.push_back(entry.path().string());
  std::sort(folders.begin(), folders.end());
  if (folders.empty())
    throw Error(location + ": no recording here; expected a folder with scene.toml, or a folder of such folders");
  return folders;
}

bool knows_truth(const std::string& folder) {
  return fs::exists(fs::path(folder) / "poses.csv") || fs::exists(fs::path(folder) / "truth");
}

void check_comparable(const std::string& folder, bool bless) {
  if (bless || knows_truth(folder) || Baseline(folder).is_kept()) return;
  throw Error(folder + ": nothing to compare with: neither poses.csv nor truth/, and no run was kept; overlay it and look at " +
              "the result, then run replay with --bless, which keeps that in baseline/ (docs/replay.md)");
}

void check_recording(const std::string& folder, const RecordingOverrides& overrides) {
  const Recording recording = open_recording(folder, overrides);
  const std::unique_ptr<MediaSource> footage = open_footage(recording);
  camera_for_footage(recording, footage->info().width_px, footage->info().height_px);
  if (recording.poses_csv) tracking::read_track_file(*recording.poses_csv);
  if (recording.truth_folder) TruthFrames(recording.folder).check_masks();
  load_scene_probe(recording.scene, {});
  load_objects(recording.scene, {});
}

ReplayResult replay_recording(const std::string& folder, const ReplayOptions& options, Log& log) {
  Recording recording = open_recording(folder, options.overrides);
  if (options.both_draw) recording.scene.renderer = Renderer::cpu;
  return knows_truth(folder) ? replay_truth(std::move(recording), options, log)
                             : replay_baseline(std::move(recording), options, log);
}

}  // namespace catchlight::app
