// Overlays a recording and measures the result: against the truth where it is known, else against a run that was kept.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/recording.hpp"
#include "app/support/log.hpp"
#include "app/tools/replay/baseline.hpp"
#include "app/tools/replay/expected.hpp"
#include "app/tools/replay/pose_comparison.hpp"
#include "app/tools/replay/renderer_comparison.hpp"
#include "app/tools/replay/truth_comparison.hpp"

namespace catchlight::app {

struct ReplayOptions {
  RecordingOverrides overrides;
  bool both_draw = false;  ///< the processor draws, and OpenGL draws every frame once more, to be compared with
  bool bless = false;      ///< a recording without truth keeps this run as its baseline
  std::string sheet;       ///< the file that the sheet becomes: plate | ours | truth or baseline | difference x 8
};

/// The greatest of the frames whose pictures are kept.
struct KeptComparison {
  int frames = 0;
  KeptDifference worst;
};

struct ReplayResult {
  std::string name;
  std::optional<PoseComparison> pose;           ///< against poses.csv, or the kept track
  std::optional<TruthComparison> pictures;      ///< where the recording has truth/
  std::optional<KeptComparison> kept;           ///< where it has no truth
  std::vector<Figure> figures;                  ///< all of them as expected.toml keeps them
  bool has_sheet = false;                       ///< whether there were pictures to compare with
  std::optional<RendererDifference> renderers;  ///< where both drew
};

/// `location` itself, or the recordings in it, by name. Throws Error where there are none.
std::vector<std::string> find_recordings(const std::string& location);

/// Whether a recording is held against truth: it has poses.csv or truth/.
bool knows_truth(const std::string& folder);

/// Throws Error where there is nothing to hold the recording against and `bless` does not make it.
void check_comparable(const std::string& folder, bool bless);

/// Opens all that a replay will read but the frames of the footage. Throws Error as replay_recording does for what is missing or
/// unreadable: masks, poses, probe, objects, camera.
void check_recording(const std::string& folder, const RecordingOverrides& overrides);

/// Truth has no grain, and glares only where the scene file says so itself (`glare.enabled = true`): both are off here otherwise.
/// A baseline is drawn as overlay draws. Throws Error as overlay does, also for a truth frame that is missing its mask or has
/// another size.
ReplayResult replay_recording(const std::string& folder, const ReplayOptions& options, Log& log);

}  // namespace catchlight::app
