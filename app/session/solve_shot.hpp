// Tracks recorded footage as a whole.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/media/frame_range.hpp"
#include "app/media/read/source.hpp"
#include "app/session/report.hpp"
#include "app/settings/scene_settings.hpp"
#include "app/support/log.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"
#include "tracking/camera/focal_length.hpp"

namespace catchlight::app {

struct SolvedShot {
  std::vector<TrackRow> rows;              ///< from the footage's first frame to the range's end
  bool is_whole = true;                    ///< no frame of the footage was left out, beyond the range either
  std::optional<std::string> damage;       ///< a text on the damage that ended the footage early
  std::optional<std::string> never_found;  ///< what to say where the tag is in none of the frames, those beyond the range too
  std::optional<tracking::FocalEstimate> focal_length;  ///< what the tag's views say of it
};

/// Tracks from the source's first frame to a second after the range's end, so that poses hardly depend on the range. Frames are
/// decoded on a thread of their own. The stages
/// are "track decode", "track" (a frame each) and "solve" (once).
SolvedShot solve_shot(MediaSource& source, const CameraModel& camera, const SceneSettings& scene, const FrameRange& range,
                      Log& log, StageTimer& stages);

/// How many frames of the source lie in the range, where that can be known; frames_to_track: how many solve_shot reads.
std::optional<std::int64_t> frames_in_range(const SourceInfo& info, const FrameRange& range);
std::optional<std::int64_t> frames_to_track(const SourceInfo& info, const FrameRange& range);

}  // namespace catchlight::app
