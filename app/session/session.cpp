#include "app/session/session.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/session/focal_check.hpp"
#include "app/session/frame_view.hpp"
#include "app/session/object_scale.hpp"
#include "app/settings/change_cost.hpp"
#include "app/settings/look.hpp"
#include "app/support/waiting.hpp"
#include "catchlight/util/text.hpp"
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

constexpr const char* kAllowLost = ". --allow-lost goes on without it";

std::string shown(const std::string& footage) {
  return footage == "-" ? "stdin" : footage;
}

PlanEntry glare_entry(const SceneSettings& scene, const Report& report) {
  if (!scene.glare.enabled) return {"glare", "off", "glare.enabled is false"};
  const std::string percent = std::to_string(std::lround(100 * report.glare_share)) + " % of the frame";
  return {"glare", "in " + std::to_string(report.glare_frames) + " of " + counted(report.frames, "frame"),
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
      footage_(open_source(recording_)),
      camera_(camera_for_footage(recording_, footage_->info().width_px, footage_->info().height_px,
                                 [&](const std::string& warning) { log_.warn(warning); })),
      renderer_(recording_.scene, camera_, {options_.wants_layers, options_.wants_frames}, log) {
  check_range(recording_.footage, options_.range, footage_->info());
  for (const std::string& warning : recording_.warnings) log_.warn(warning);
  if (footage_->info().is_interlaced)
    log_.warn(shown(recording_.footage) +
              " is interlaced: every other row is of another moment, and edges that move are combs; deinterlace it first, "
              "as with `ffmpeg -i IN -vf bwdif OUT`");
  if (options_.wants_layers && recodes_every_frame(recording_.scene))
    log_.warn("layers hold the scene's light: neither exposure.mode \"auto\" nor the classic look is in them");
}

void Session::prepare() {
  renderer_.load();
  renderer_.check_aperture();
  renderer_.open_renderer();
  note_scale();
  const bool is_drawn =
      opened_track().finds_any(options_.range) || (recodes_every_frame(recording_.scene) && !options_.wants_layers);
  if (is_drawn) measure("build", [&] { renderer_.prepare(); });
}

void Session::note_scale() {
  pass_.report.object.clear();
  const std::optional<TrackRow> row = opened_track().middle_row(options_.range);
  if (!row) return;
  const BuiltScene& built = renderer_.load();
  const render::Bounds box = render::bounds_of(built.scene.mesh);
  const RigidTransform camera_from_scene = row->camera_from_tag * built.tag_from_scene;
  pass_.report.object = scale_text(box, recording_.scene.tag.size_m, camera_from_scene);
  if (const auto warning = scale_warning(box, camera_, camera_from_scene)) log_.warn(*warning);
}

std::optional<FrameJob> Session::decode() {
  opened_track();
  if (!progress_ && !options_.is_revisited)
    progress_.emplace(log_, options_.task, frames_in_range(footage_->info(), options_.range));
  try {
    std::optional<Frame> frame = measure("decode", [&] { return next_frame(); });
    if (frame && frame->number() < options_.range.end) {
      ++pass_.decoded;
      const bool is_before_range = frame->number() < options_.range.begin;
      if (!is_before_range) ++pass_.in_range;
      if (progress_) progress_->update(pass_.in_range, live_state());
      return FrameJob{.image = std::move(*frame), .is_before_range = is_before_range};
    }
  } catch (const DamagedMedia& damaged) {
    pass_.damage = damaged.what();
  }
  progress_.reset();
  if (pass_.in_range == 0 && pass_.damage) throw DamagedMedia(*pass_.damage);
  if (pass_.in_range == 0) refuse_range(recording_.footage, options_.range, pass_.decoded, footage_->info().first_number);
  return std::nullopt;
}

std::optional<std::int64_t> Session::frame_count() {
  opened_track();
  return tracked_frames_ ? tracked_frames_ : footage_->info().frame_count;
}

void Session::seek(std::int64_t position) {
  FrameTrack& track = opened_track();
  if (renderer_.adapts() && !footage_->info().is_one_pass)
    renderer_.adapt_until(static_cast<std::size_t>(position), [&](std::size_t before) -> std::optional<FrameJob> {
      footage_->seek(static_cast<std::int64_t>(before));
      std::optional<Frame> frame = footage_->read();
      if (!frame) return {};
      FrameJob job{.image = std::move(*frame)};
      job.track = track.row(job.image);
      return job;
    });
  footage_->seek(position);
}

std::optional<Frame> Session::next_frame() {
  if (!footage_->info().is_one_pass) return footage_->read();
  const Waiting waiting(log_, "frames from " + shown(recording_.footage));
  return footage_->read();
}

std::string Session::live_state() const {
  if (!footage_->info().is_live) return "";
  return fixed_text(delay_s_, 1) + " s behind, " + std::to_string(footage_->dropped_frames()) + " dropped";
}

void Session::finish(const FrameJob& job) {
  if (!footage_->info().is_live) return;
  const std::chrono::duration<double> delay = std::chrono::steady_clock::now() - job.image.decoded_at();
  delay_s_ = delay.count();
  pass_.report.stages.add("delay", 1000 * delay.count());
}

void Session::track(FrameJob& job) {
  FrameTrack& track = opened_track();
  job.track = track.is_tracking() ? measure("track", [&] { return track.row(job.image); }) : track.row(job.image);
  if (job.is_before_range) return;
  if (track_check_) track_check_->see(job.image.number(), job.image.time_s());
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
  return options_.track_file.empty() && !options_.is_causal && !footage_->info().is_one_pass;
}

FrameTrack& Session::opened_track() {
  if (!track_) track_ = open_track();
  return *track_;
}

std::unique_ptr<FrameTrack> Session::open_track() {
  const SceneSettings& scene = recording_.scene;
  if (!options_.track_file.empty()) {
    tracking::TrackFile file = tracking::read_track_file(options_.track_file);
    track_check_.emplace(options_.track_file, file, camera_, scene.tag.target(), footage_->info(), log_.warning_handler());
    if (std::ranges::none_of(file.rows, &TrackRow::found)) note_never_found(options_.track_file + ": no frame of it has a pose");
    return make_recorded_track(std::move(file.rows), camera_, scene);
  }
  if (!is_solved_whole()) return make_tag_track(camera_, scene);
  footage_->keep(frames_to_track(footage_->info(), options_.range));
  SolvedShot solved = solve();
  footage_->rewind();
  tracked_frames_ = static_cast<std::int64_t>(solved.rows.size());
  return make_recorded_track(std::move(solved.rows), camera_, scene);
}

SolvedShot Session::solve() {
  SolvedShot solved = solve_shot(*footage_, camera_, recording_.scene, options_.range, log_, pass_.report.stages);
  if ((solved.never_found || options_.is_revisited) && solved.damage) log_.warn(*solved.damage);
  if (options_.is_revisited) pass_.damage = solved.damage;
  if (solved.never_found) note_never_found(*solved.never_found);
  if (!solved.is_whole)
    log_.info(
        "grain, focus and motion blur are measured only as far as this part needs tracking, and may differ from the whole's; "
        "`catchlight track -o track.csv` without --frames, then --track track.csv, draws any part as the whole would be");
  if (solved.focal_length) tell_focal_length(*solved.focal_length, camera_, recording_, log_);
  return solved;
}

void Session::note_never_found(const std::string& text) {
  if (!options_.allows_lost) throw Error(text + kAllowLost);
  never_found_ = text;
}

std::unique_ptr<RewindableSource> Session::open_source(const Recording& recording) {
  const Waiting waiting(log_, shown(recording.footage));
  return std::make_unique<RewindableSource>(
      open_footage(recording, log_.warning_handler(), options_.hooks),
      [this] { return open_footage(recording_, {}, options_.hooks); }, options_.kept_bytes);
}

void Session::track_range(const std::function<void(const TrackRow&)>& take) {
  if (is_solved_whole()) {
    std::vector<TrackRow> rows;
    SolvedShot solved = solve();
    pass_.damage = solved.damage;
    for (const TrackRow& row : solved.rows)
      if (options_.range.contains(row.frame)) rows.push_back(row);
    if (rows.empty() && !solved.damage)
      refuse_range(recording_.footage, options_.range, static_cast<std::int64_t>(solved.rows.size()),
                   footage_->info().first_number);
    for (const TrackRow& row : rows) {
      pass_.report.count(row);
      take(row);
    }
    return;
  }
  while (std::optional<FrameJob> job = decode()) {
    track(*job);
    if (!job->is_before_range) take(job->track);
    finish(*job);
  }
}

std::vector<TrackRow> Session::track_range() {
  std::vector<TrackRow> rows;
  track_range([&](const TrackRow& row) { rows.push_back(row); });
  return rows;
}

void Session::apply(const SceneSettings& settings, BakeFineness fineness) {
  const std::set<ChangeCost> costs = costs_of_change(recording_.scene, settings);
  const bool is_tracked_anew = costs.contains(ChangeCost::track) || costs.contains(ChangeCost::footage);
  const bool is_one_pass = footage_->info().is_one_pass;
  if (is_one_pass && costs.contains(ChangeCost::footage))
    throw Error(recording_.footage + ": live footage cannot be read in another way while it runs; open it anew");
  Recording changed = recording_;
  changed.scene = settings;
  if (is_tracked_anew && !is_one_pass) {
    footage_ = open_source(changed);  // where this throws, all is as before
    progress_.reset();
    pass_ = {};
    renderer_.restart();
  }
  recording_ = std::move(changed);
  renderer_.apply(settings, fineness);
  if (is_tracked_anew) track_.reset(), tracked_frames_.reset(), never_found_.reset();
}

void Session::warn_of_track() {
  if (const auto warning = track_ ? track_->warning() : std::nullopt) log_.warn(*warning);
  const Report& report = pass_.report;
  const std::string of_frames = " of " + counted(report.frames, "frame");
  if (track_ && !never_found_) never_found_ = track_->never_found();
  if (never_found_) {
    if (options_.allows_lost) log_.warn(*never_found_ + "; all frames pass through untouched");
  } else if (report.lost_frames > 0) {
    log_.warn("no tag in " + std::to_string(report.lost_frames) + of_frames + ", which pass through untouched" +
              (track_check_ ? track_check_->missing_rows() : ""));
  }
}

std::vector<std::string> Session::failures() const {
  std::vector<std::string> failures;
  if (never_found_ && !options_.allows_lost) failures.push_back(*never_found_ + kAllowLost);
  if (pass_.damage) failures.push_back(*pass_.damage);
  return failures;
}

/// How often the footage is decoded, and why.
PlanEntry Session::footage_entry() const {
  if (footage_->info().is_live)
    return {"footage", "decoded once",
            "live footage is tracked frame by frame; " + std::to_string(footage_->dropped_frames()) +
                " frames were dropped for newer ones"};
  if (footage_->info().is_one_pass) return {"footage", "decoded once", "it can be read once, and is tracked frame by frame"};
  if (!is_solved_whole()) return {"footage", "decoded once", "it is not tracked as a whole"};
  const auto megabytes = [](std::int64_t bytes) { return std::to_string((bytes + 500'000) / 1'000'000) + " MB"; };
  const RewindableSource::Kept& kept = footage_->kept();
  if (kept.has_all) return {"footage", "decoded once", "tracking leaves its frames in memory, " + megabytes(kept.bytes)};
  return {"footage", "decoded twice", "its frames take more than the " + megabytes(kept.budget_bytes) + " that may be kept"};
}

std::vector<PlanEntry> Session::plan() const {
  std::vector<PlanEntry> plan = renderer_.plan();
  if (!pass_.last_image) return plan;
  const bool is_built = !plan.empty();
  plan.push_back(footage_entry());
  if (!is_built) return plan;
  plan.push_back(glare_entry(recording_.scene, pass_.report));
  std::vector<TrackRow> rows = pass_.typical_rows.values();
  if (rows.back().frame != pass_.last_row.frame) rows.push_back(pass_.last_row);
  std::ranges::move(lens_plan(recording_.scene, rows, *pass_.last_image, camera_.vignetting, !options_.track_file.empty()),
                    std::back_inserter(plan));
  return plan;
}

Report Session::report() const {
  Report report = pass_.report;
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - pass_.start).count();
  report.fps = elapsed_s > 0 ? static_cast<double>(report.frames) / elapsed_s : 0;
  report.renderer = renderer_.renderer_name();
  report.dropped_frames = footage_->dropped_frames();
  report.plan = plan();
  report.warnings = log_.warnings();
  return report;
}

}  // namespace catchlight::app
