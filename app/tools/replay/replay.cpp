#include "app/tools/replay/replay.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "app/session/run_stages.hpp"
#include "app/tools/replay/sheet.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/error.hpp"
#include "catchlight/plate.hpp"
#include "render/image/picture_file.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {

namespace fs = std::filesystem;

namespace {

cv::Mat bgr_of(const Frame& frame) {
  const Plate plate = frame.rgb({0, 0, frame.width_px(), frame.height_px()});
  const int depth = plate.format == Plate::Format::rgb_u8    ? CV_8UC3
                    : plate.format == Plate::Format::rgb_u16 ? CV_16UC3
                                                             : CV_32FC3;
  const double to_8_bit = depth == CV_8UC3 ? 1.0 : depth == CV_16UC3 ? 1.0 / 257 : 255.0;
  const cv::Mat codes(plate.rect.height, plate.rect.width, depth, const_cast<std::byte*>(plate.pixels.data()));
  cv::Mat bgr;
  cv::cvtColor(codes, bgr, cv::COLOR_RGB2BGR);
  bgr.convertTo(bgr, CV_8U, to_8_bit);
  return bgr;
}

/// The frames of a recording whose truth is known, and how ours differ from it.
class TruthFrames {
 public:
  explicit TruthFrames(std::string folder) : folder_(std::move(folder)) {}

  bool has(std::int64_t number) const { return fs::exists(path("truth", number)); }

  void compare(const Frame& plate, const Composite& composite) {
    const cv::Mat ours = bgr_of(composite.rect.empty() ? plate : plate.with_composite(composite)), plate_bgr = bgr_of(plate);
    const cv::Mat truth = read(path("truth", plate.number()), ours.size());
    const fs::path clean_path = path("plate_clean", plate.number());
    const cv::Mat clean = fs::exists(clean_path) ? read(clean_path, ours.size()) : plate_bgr;
    cv::Mat mask = read(path("mask", plate.number()), ours.size());
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

  static cv::Mat read(const fs::path& path, const cv::Size& size) {
    if (!fs::exists(path)) throw Error(path.string() + ": missing; every frame of truth/ needs its mask/");
    cv::Mat image = render::read_picture(path.string(), render::PictureDepth::eight_bits);
    if (image.size() != size)
      throw Error(path.string() + ": is " + std::to_string(image.cols) + "x" + std::to_string(image.rows) + ", the footage is " +
                  std::to_string(size.width) + "x" + std::to_string(size.height));
    return image;
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

ReplayResult replay_recording(const std::string& location, const RecordingOverrides& overrides, bool both_draw,
                              const std::string& sheet_path, Log& log) {
  Recording recording = open_recording(location, overrides);
  if (!recording.scene.is_by_hand("glare.enabled")) recording.scene.glare.enabled = false;
  recording.scene.lens.noise = Switch::off;
  if (both_draw) recording.scene.renderer = Renderer::cpu;
  Session session(std::move(recording), {.keeps_track = true}, log);
  TruthFrames truth(session.recording().folder);
  std::optional<RendererComparison> renderers;
  if (both_draw) renderers.emplace(session.settings(), session.camera(), log);
  const auto has_truth = [&](const FrameJob& job) { return truth.has(job.image.number()); };
  const auto write = [&](const FrameJob& job) {
    if (has_truth(job)) truth.compare(job.image, job.result);
  };
  const auto look = [&](const FrameJob& job) {
    if (renderers) renderers->compare(job);
  };
  run_stages(session, write, {.wants = [&](const FrameJob& job) { return both_draw || has_truth(job); }, .look = look});
  if (session.damage()) throw Error(*session.damage());
  session.warn_of_track();

  ReplayResult result;
  result.name = session.recording().name;
  if (renderers) result.renderers = renderers->difference();
  if (const auto& poses = session.recording().poses_csv) {
    result.pose =
        compare_poses(session.track_rows(), tracking::read_track_file(*poses), session.camera(), session.settings().tag.size_m);
    add_figures(*result.pose, result.figures);
  }
  if (!truth.comparisons.empty()) {
    result.pictures = mean_of(truth.comparisons);
    add_figures(*result.pictures, session.settings().glare.enabled, result.figures);
    write_sheet(sheet_path, truth.sheet_rows);
  }
  if (result.figures.empty()) throw Error(location + ": nothing to compare with; expected poses.csv or truth/ with mask/");
  return result;
}

}  // namespace catchlight::app
