// What a file that is dropped on the window is good for.
#pragma once

#include <optional>
#include <string>

#include "app/window/editing/opened_recording.hpp"

namespace catchlight::app {

enum class DroppedKind { recording, scene, footage, probe, model, other };

/// By what is there, and by the ending of its name.
DroppedKind kind_of_dropped(const std::string& path);

/// What a dropped recording, scene or footage opens. `now`: what is open, if something is; footage gets its scene and its camera.
OpenedRecording opened_by_drop(const std::string& path, const RecordingOverrides& given, const std::optional<Recording>& now);

}  // namespace catchlight::app
