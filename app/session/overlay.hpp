// The main job: footage in, the virtual object put into every frame, footage out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/media/frame_range.hpp"
#include "app/media/write/frame_output.hpp"
#include "app/session/frame_track.hpp"
#include "app/session/recording.hpp"
#include "app/session/report.hpp"
#include "app/session/stage.hpp"
#include "app/support/log.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

struct OverlayResult {
  std::vector<TrackRow> rows;         ///< of the frames in range
  std::optional<std::string> damage;  ///< the footage broke off: what is known about it
};

/// How many frames of a finished job passed through untouched, and what to check where all did; nothing where none did.
void warn_of_lost_frames(const Report& report, Log& log);

/// Reads from the source's first frame on, so that the tracker's memory does not depend on the range, and renders the range.
/// Finishes the output, after damaged footage too. Adds counts, stages and warnings to the report.
OverlayResult run_overlay(MediaSource& source, FrameTrack& track, Stage& stage, const SceneSettings& scene,
                          const CameraModel& camera, FrameOutput& output, const FrameRange& range, Log& log, Report& report);

/// Tracks live footage without drawing anything.
OverlayResult run_track(MediaSource& source, FrameTrack& track, const FrameRange& range, Log& log, Report& report);

/// Tracks recorded footage as a whole, without drawing anything: from its first frame to a second after the range's end, so that
/// poses hardly depend on the range. Rows are of the frames in range.
OverlayResult solve_track(MediaSource& source, const CameraModel& camera, const SceneSettings& scene, const FrameRange& range,
                          Log& log, Report& report);

}  // namespace catchlight::app
