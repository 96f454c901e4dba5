#include "app/session/solve_shot.hpp"

#include <algorithm>
#include <thread>

#include "app/session/frame_track.hpp"
#include "app/support/progress.hpp"
#include "catchlight/util/bounded_queue.hpp"

namespace catchlight::app {
namespace {

constexpr std::size_t kWaitingFrames = 4;  ///< decoded, not tracked yet

/// The range with a second more at its end, so that the last poses know what comes after them.
FrameRange with_a_second_more(FrameRange range, const SourceInfo& info) {
  const auto second = static_cast<std::int64_t>(std::max(info.frame_rate, 1.0));
  range.end = std::min(range.end, FrameRange{}.end - second) + second;
  return range;
}

/// The number behind the last frame of the range, where that can be known.
std::optional<std::int64_t> end_of(const SourceInfo& info, const FrameRange& range) {
  const bool has_end = range.end != FrameRange{}.end;
  if (!info.frame_count) return has_end ? std::optional(range.end) : std::nullopt;
  return std::min(range.end, info.first_number + *info.frame_count);
}

}  // namespace

std::optional<std::int64_t> frames_in_range(const SourceInfo& info, const FrameRange& range) {
  const std::optional<std::int64_t> end = end_of(info, range);
  return end ? std::optional(*end - std::max(range.begin, info.first_number)) : std::nullopt;
}

std::optional<std::int64_t> frames_to_track(const SourceInfo& info, const FrameRange& range) {
  const std::optional<std::int64_t> end = end_of(info, with_a_second_more(range, info));
  return end ? std::optional(*end - info.first_number) : std::nullopt;
}

SolvedShot solve_shot(MediaSource& source, const CameraModel& camera, const SceneSettings& scene, const FrameRange& range,
                      Log& log, StageTimer& stages) {
  SolvedShot shot;
  ShotTrack track(camera, scene);
  const FrameRange read_range = with_a_second_more(range, source.info());
  Progress progress(log, "track", frames_to_track(source.info(), range));
  const auto decode = [&]() -> std::optional<Frame> {
    std::optional<Frame> frame = stages.measure("track decode", [&] { return source.read(); });
    shot.is_whole = !frame || frame->number() < read_range.end;
    return shot.is_whole ? std::move(frame) : std::nullopt;
  };
  try {
    BoundedQueue<Frame> decoded(kWaitingFrames);
    const std::jthread decoding([&] { fill(decoded, decode); });
    std::int64_t tracked = 0;
    drain(decoded, [&](const Frame& frame) {
      stages.measure("track", [&] { track.add(frame); });
      progress.update(++tracked);
    });
  } catch (const DamagedMedia& damaged) {
    shot.damage = damaged.what();
  }
  stages.measure("solve", [&] {
    shot.rows = track.solve();
    shot.focal_length = track.focal_length();
  });
  shot.never_found = track.never_found();
  if (const auto warning = track.warning(shot.rows)) log.warn(*warning);
  std::erase_if(shot.rows, [&](const TrackRow& row) { return row.frame >= range.end; });
  return shot;
}

}  // namespace catchlight::app
