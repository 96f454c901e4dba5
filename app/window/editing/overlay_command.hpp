// The command line that draws what the window shows.
#pragma once

#include <string>
#include <vector>

#include "app/media/frame_range.hpp"
#include "app/session/recording.hpp"

namespace catchlight::app {

/// The arguments of `catchlight overlay` for a recording opened with `overrides`, whose files say `file`, under the settings
/// `now`. `range` with no bounds: all frames.
std::vector<std::string> overlay_arguments(const std::string& location, const RecordingOverrides& overrides,
                                           const SceneSettings& file, const SceneSettings& now, const FrameRange& range,
                                           const std::string& output);

/// Arguments as a shell takes them: quoted where they need it.
std::string shell_text(const std::vector<std::string>& arguments);

}  // namespace catchlight::app
