// Overlays a recording whose truth is known and measures the result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/recording.hpp"
#include "app/support/log.hpp"
#include "app/tools/replay/expected.hpp"
#include "app/tools/replay/pose_comparison.hpp"
#include "app/tools/replay/renderer_comparison.hpp"
#include "app/tools/replay/truth_comparison.hpp"

namespace catchlight::app {

struct ReplayResult {
  std::string name;
  std::optional<PoseComparison> pose;           ///< where the recording has poses.csv
  std::optional<TruthComparison> pictures;      ///< where it has truth/
  std::vector<Figure> figures;                  ///< both as expected.toml keeps them
  std::optional<RendererDifference> renderers;  ///< where both drew
};

/// `location` itself, or the recordings in it, by name. Throws Error where there are none.
std::vector<std::string> find_recordings(const std::string& location);

/// Truth has no grain, and glares only where the scene file says so itself (`glare.enabled = true`): both are off here otherwise.
/// Writes the sheet plate | ours | truth | difference x 8 to `sheet_path` where there is truth. Throws Error as overlay does,
/// also for a truth frame that is missing its mask or has another size. `both_draw`: the processor draws, and OpenGL draws every
/// frame once more, to be compared with.
ReplayResult replay_recording(const std::string& location, const RecordingOverrides& overrides, bool both_draw,
                              const std::string& sheet_path, Log& log);

}  // namespace catchlight::app
