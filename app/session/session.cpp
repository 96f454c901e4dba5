#include "app/session/session.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/session/frame_view.hpp"
#include "app/session/solve_shot.hpp"
#include "app/settings/change_cost.hpp"
#include "app/settings/look.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {
namespace {

/// What there is instead, and what to do, where no frame lies in the range.
[[noreturn]] void refuse_range(const std::string& footage, const FrameRange& range, std::int64_t count, std::int64_t first) {
  const std::string wanted = range.end == range.begin + 1 ? "there is no frame " + std::to_string(range.begin)
                                                          : "no frame of the footage lies in --frames";
  throw Error(footage + ": " + wanted + "; it has " + std::to_string(count) + " from " + std::to_string(first) +
              "; choose frames that it has");
}

/// Refuses a range that lies beside the footage, where that says how long it is, before anything is done.
void check_range(const std::string& footage, const FrameRange& range, const SourceInfo& info) {
  if (!info.frame_count) return;
  if (range.begin >= info.first_number + *info.frame_count || range.end <= info.first_number)
    refuse_range(footage, range, *info.frame_count, info.first_number);
}

PlanEntry glare_entry(const SceneSettings& scene, const Report& report) {
  if (!scene.glare.enabled) return {"glare", "off", "glare.enabled is false"};
  const std::string percent = std::to_string(std::lround(100 * report.glare_share)) + " % of the frame";
  return {"glare", "in " + std::to_string(report.glare_frames) + " of " + std::to_string(report.frames) + " frames",
          report.glare_frames == 0 ? "nothing of the object exceeds the sensor's white"
                                   : "light over the sensor's white; it reached " + percent + " on average"};
}

void count_glare(const Composite& composite, const CameraModel& camera, Report& report) {
  if (!composite.glare_drawn) return;
  const PixelRect& reached = composite.glare_rect;
  const double share =
      static_cast<double>(reached.width) * reached.height / (static_cast<double>(camera.width_px) * camera.height_px);
  ++report.glare_frames;
  report.glare_share += (share - report.glare_share) / static_cast<double>(report.glare_frames);
}

}  // namespace

Session::Session(Recording recording, SessionOptions options, Log& log)
    : recording_(std::move(recording)),
      options_(std::move(options)),
      log_(log),
      footage_(open_footage(recording_, log.warning_handler())),
      camera_(camera_for_footage(recording_, footage_->info().width_px, footage_->info().height_px)),
      renderer_(recording_.scene, camera_, options_.wants_layers, log) {
  check_range(recording_.footage, options_.range, footage_->info());
  if (options_.wants_layers && recodes_every_frame(recording_.scene))
    log_.warn("layers hold the scene's light: neither exposure.mode \"auto\" nor the classic look is in them");
}

void Session::prepare() {
  renderer_.load();
  renderer_.open_gl();
  opened_track();
  measure("build", [&] { renderer_.prepare(); });
}

std::optional<FrameJob> Session::decode() {
  const FrameTrack& track = opened_track();
  if (!progress_) progress_.emplace(log_, options_.task, frames_to_read(footage_->info(), options_.range));
  try {
    std::optional<Frame> frame = measure("decode", [&] { return footage_->read(); });
    if (frame && frame->number() < options_.range.end) {
      progress_->update(++pass_.decoded);
      const bool is_before_range = frame->number() < options_.range.begin;
      if (!is_before_range) ++pass_.in_range;
      return FrameJob{.image = std::move(*frame), .is_before_range = is_before_range};
    }
  } catch (const DamagedMedia& damaged) {
    pass_.damage = damaged.what();
  }
  progress_.reset();
  if (pass_.in_range == 0 && pass_.damage) throw DamagedMedia(*pass_.damage);
  if (pass_.in_range == 0) refuse_range(recording_.footage, options_.range, pass_.decoded, footage_->info().first_number);
  if (const auto warning = track.warning()) log_.warn(*warning);
  return std::nullopt;
}

void Session::track(FrameJob& job) {
  FrameTrack& track = opened_track();
  job.track = track.is_tracking() ? measure("track", [&] { return track.row(job.image); }) : track.row(job.image);
  if (job.is_before_range) return;
  pass_.report.count(job.track);
  if (options_.keeps_track) pass_.rows.push_back(job.track);
  pass_.typical_rows.add(job.track);
  pass_.last_image = job.image;
  pass_.last_row = job.track;
}

void Session::render(FrameJob& job) {
  renderer_.render(job);
  const bool is_first_time = pass_.last_drawn != job.image.number();
  pass_.last_drawn = job.image.number();
  if (is_first_time) count_glare(job.result, camera_, pass_.report);
  for (const render::PassTime& pass : renderer_.pass_times()) pass_.report.stages.add(pass.name, pass.ms);
}

bool Session::is_solved_whole() const {
  return options_.track_file.empty() && !options_.is_causal && !footage_->info().is_live;
}

FrameTrack& Session::opened_track() {
  if (!track_) track_ = open_track();
  return *track_;
}

std::unique_ptr<FrameTrack> Session::open_track() {
  const SceneSettings& scene = recording_.scene;
  if (!options_.track_file.empty()) return make_recorded_track(tracking::read_track_file(options_.track_file), camera_, scene);
  if (!is_solved_whole()) return make_tag_track(camera_, scene);
  return make_recorded_track(
      solve_shot(*open_footage(recording_), camera_, scene, options_.range, log_, pass_.report.stages).rows, camera_, scene);
}

std::vector<TrackRow> Session::track_range() {
  std::vector<TrackRow> rows;
  if (is_solved_whole()) {
    SolvedShot solved = solve_shot(*footage_, camera_, recording_.scene, options_.range, log_, pass_.report.stages);
    pass_.damage = solved.damage;
    for (const TrackRow& row : solved.rows)
      if (options_.range.contains(row.frame)) rows.push_back(row);
    if (rows.empty() && !solved.damage)
      refuse_range(recording_.footage, options_.range, static_cast<std::int64_t>(solved.rows.size()),
                   footage_->info().first_number);
    for (const TrackRow& row : rows) pass_.report.count(row);
    return rows;
  }
  while (std::optional<FrameJob> job = decode()) {
    track(*job);
    if (!job->is_before_range) rows.push_back(job->track);
  }
  return rows;
}

void Session::apply(const SceneSettings& settings) {
  const std::set<ChangeCost> costs = costs_of_change(recording_.scene, settings);
  const bool is_tracked_anew = costs.contains(ChangeCost::track) || costs.contains(ChangeCost::footage);
  const bool is_live = footage_->info().is_live;
  if (is_live && costs.contains(ChangeCost::footage))
    throw Error(recording_.footage + ": live footage cannot be read in another way while it runs; open it anew");
  Recording changed = recording_;
  changed.scene = settings;
  if (is_tracked_anew && !is_live) {
    footage_ = open_footage(changed, log_.warning_handler());  // where this throws, all is as before
    progress_.reset();
    pass_ = {};
    renderer_.restart();
  }
  recording_ = std::move(changed);
  renderer_.apply(settings);
  if (is_tracked_anew) track_.reset();
}

std::vector<PlanEntry> Session::plan() const {
  std::vector<PlanEntry> plan = renderer_.plan();
  if (plan.empty() || !pass_.last_image) return plan;
  plan.push_back(glare_entry(recording_.scene, pass_.report));
  std::vector<TrackRow> rows = pass_.typical_rows.values();
  if (rows.back().frame != pass_.last_row.frame) rows.push_back(pass_.last_row);
  std::ranges::move(lens_plan(recording_.scene.lens, rows, *pass_.last_image, camera_.vignetting), std::back_inserter(plan));
  return plan;
}

Report Session::report() const {
  Report report = pass_.report;
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - pass_.start).count();
  report.fps = elapsed_s > 0 ? static_cast<double>(report.frames) / elapsed_s : 0;
  report.renderer = renderer_.gl_renderer();
  report.plan = plan();
  report.warnings = log_.warnings();
  return report;
}

void warn_of_lost_frames(const Report& report, Log& log) {
  const std::string of_frames = " of " + std::to_string(report.frames) + " frames";
  if (report.frames > 0 && report.lost_frames == report.frames)
    log.warn("the tag was never found in " + std::to_string(report.frames) +
             " frames, which pass through untouched; check tag.family, tag.id and that the tag is sharp and at least 20 px wide");
  else if (report.lost_frames > 0)
    log.warn("no tag in " + std::to_string(report.lost_frames) + of_frames + ", which pass through untouched");
}

}  // namespace catchlight::app
