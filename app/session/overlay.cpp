#include "app/session/overlay.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

#include "app/media/pixels/full_color.hpp"
#include "app/session/debug_drawing.hpp"
#include "app/session/frame_view.hpp"
#include "app/settings/look.hpp"
#include "app/support/progress.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/error.hpp"
#include "catchlight/pixel_rect.hpp"

namespace catchlight::app {

namespace {

/// Frames of the source that the range leaves, where that can be known.
std::optional<std::int64_t> frames_to_read(const SourceInfo& info, const FrameRange& range) {
  if (range.end != FrameRange{}.end && !info.frame_count) return range.end - info.first_number;
  if (!info.frame_count) return {};
  return std::min(*info.frame_count, range.end == FrameRange{}.end ? *info.frame_count : range.end - info.first_number);
}

void count(const TrackRow& row, Report& report) {
  ++report.frames;
  switch (row.state) {
    case TrackState::tracking:
      ++report.tracked_frames;
      break;
    case TrackState::coasting:
      ++report.coasting_frames;
      break;
    case TrackState::lost:
      ++report.lost_frames;
      break;
  }
}

double frames_per_second(std::int64_t frames, std::chrono::steady_clock::time_point since) {
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  return elapsed_s > 0 ? static_cast<double>(frames) / elapsed_s : 0;
}

/// Far enough past the end that the last poses know what comes after them.
FrameRange with_a_second_more(FrameRange range, const SourceInfo& info) {
  const auto second = static_cast<std::int64_t>(std::max(info.frame_rate, 1.0));
  range.end = std::min(range.end, FrameRange{}.end - second) + second;
  return range;
}

/// Hands on every frame from the source's first to the range's end. Returns what is known of damage that ended the footage.
template <class PerFrame>
std::optional<std::string> read_frames(MediaSource& source, const FrameRange& range, const char* task, Log& log,
                                       StageTimer& stages, PerFrame per_frame) {
  Progress progress(log, task, frames_to_read(source.info(), range));
  std::int64_t read = 0;
  try {
    while (const std::optional<Frame> frame = stages.measure("decode", [&] { return source.read(); })) {
      if (frame->number() >= range.end) break;
      per_frame(*frame);
      progress.update(++read);
    }
  } catch (const DamagedMedia& damaged) {
    return damaged.what();
  }
  return std::nullopt;
}

/// Decodes and tracks from the first frame to the range's end, and hands on what is in the range, and what comes before it.
template <class PerFrame, class PerEarlierFrame>
OverlayResult run(MediaSource& source, FrameTrack& track, const FrameRange& range, const char* task, Log& log, Report& report,
                  PerFrame per_frame, PerEarlierFrame per_earlier_frame) {
  OverlayResult result;
  const auto start = std::chrono::steady_clock::now();
  result.damage = read_frames(source, range, task, log, report.stages, [&](const Frame& frame) {
    const TrackRow row =
        track.is_tracking() ? report.stages.measure("track", [&] { return track.row(frame); }) : track.row(frame);
    if (!range.contains(frame.number())) return per_earlier_frame(frame, row);
    per_frame(frame, row);
    count(row, report);
    result.rows.push_back(row);
  });
  if (const auto warning = track.warning()) log.warn(*warning);
  report.fps = frames_per_second(report.frames, start);
  return result;
}

void count_glare(const Composite& composite, const CameraModel& camera, Report& report) {
  if (!composite.glare_drawn) return;
  const PixelRect& reached = composite.glare_rect;
  const double share =
      static_cast<double>(reached.width) * reached.height / (static_cast<double>(camera.width_px) * camera.height_px);
  ++report.glare_frames;
  report.glare_share += (share - report.glare_share) / static_cast<double>(report.glare_frames);
}

void add_glare_to_plan(const SceneSettings& scene, Report& report) {
  if (!scene.glare.enabled) {
    report.plan.push_back({"glare", "off", "glare.enabled is false"});
    return;
  }
  const std::string percent = std::to_string(std::lround(100 * report.glare_share)) + " % of the frame";
  report.plan.push_back({"glare",
                         "in " + std::to_string(report.glare_frames) + " of " + std::to_string(report.frames) + " frames",
                         report.glare_frames == 0 ? "nothing of the object exceeds the sensor's white"
                                                  : "light over the sensor's white; it reached " + percent + " on average"});
}

}  // namespace

void warn_of_lost_frames(const Report& report, Log& log) {
  const std::string of_frames = " of " + std::to_string(report.frames) + " frames";
  if (report.frames > 0 && report.lost_frames == report.frames)
    log.warn("the tag was never found in " + std::to_string(report.frames) +
             " frames, which pass through untouched; check tag.family, tag.id and that the tag is sharp and at least 20 px wide");
  else if (report.lost_frames > 0)
    log.warn("no tag in " + std::to_string(report.lost_frames) + of_frames + ", which pass through untouched");
}

OverlayResult run_overlay(MediaSource& source, FrameTrack& track, Stage& stage, const SceneSettings& scene,
                          const CameraModel& camera, FrameOutput& output, const FrameRange& range, Log& log, Report& report) {
  std::optional<Frame> last;
  const bool full_color = scene.lens.chroma_subsampling == Switch::off;
  FrameDrawing drawing(stage, scene, camera, output.wants_layers());
  if (output.wants_layers() && recodes_every_frame(scene))
    log.warn("layers hold the scene's light: neither exposure.mode \"auto\" nor the classic look is in them");
  const auto pass_over = [&](const Frame& frame, const TrackRow& row) { drawing.pass_over(frame, row); };
  const auto per_frame = [&](const Frame& frame, const TrackRow& row) {
    last = frame;
    if (!output.wants_frame(frame.number())) return pass_over(frame, row);
    Composite composite = drawing.draw(frame, row);
    count_glare(composite, camera, report);
    for (const render::PassTime& pass : drawing.pass_times()) report.stages.add(pass.name, pass.ms);
    if (stage.draws_debug) draw_debug(frame, row, camera, scene.tag.size_m, composite);
    report.stages.measure("encode", [&] { output.write(full_color ? with_full_color(frame) : frame, composite); });
  };
  const OverlayResult result = run(source, track, range, "overlay", log, report, per_frame, pass_over);
  if (report.frames == 0)
    throw Error("no frame of the footage lies in --frames; it has " + std::to_string(source.info().frame_count.value_or(0)) +
                " from " + std::to_string(source.info().first_number));
  output.finish();
  add_glare_to_plan(scene, report);
  std::ranges::move(lens_plan(scene.lens, result.rows, *last, camera.vignetting), std::back_inserter(report.plan));
  warn_of_lost_frames(report, log);
  return result;
}

OverlayResult run_track(MediaSource& source, FrameTrack& track, const FrameRange& range, Log& log, Report& report) {
  const auto nothing_more = [](const Frame&, const TrackRow&) {};
  return run(source, track, range, "track", log, report, nothing_more, nothing_more);
}

OverlayResult solve_track(MediaSource& source, const CameraModel& camera, const SceneSettings& scene, const FrameRange& range,
                          Log& log, Report& report) {
  OverlayResult result;
  ShotTrack track(camera, scene);
  const auto start = std::chrono::steady_clock::now();
  const auto add = [&](const Frame& frame) { report.stages.measure("track", [&] { track.add(frame); }); };
  result.damage = read_frames(source, with_a_second_more(range, source.info()), "track", log, report.stages, add);
  const std::vector<TrackRow> solved = report.stages.measure("solve", [&] { return track.solve(); });
  for (const TrackRow& row : solved)
    if (range.contains(row.frame)) result.rows.push_back(row);
  for (const TrackRow& row : result.rows) count(row, report);
  if (const auto warning = track.warning(solved)) log.warn(*warning);
  report.fps = frames_per_second(report.frames, start);
  return result;
}

}  // namespace catchlight::app
