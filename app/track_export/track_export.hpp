// A track for other programs. The extension of the file's name says the format; docs/track-formats.md has a table of them.
#pragma once

#include <string>
#include <vector>

#include "app/track_export/shot.hpp"
#include "catchlight/error.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

/// Throws UsageError naming the extensions there are, where `path` has another.
void check_track_format(const std::string& path);

/// `.csv` and `.jsonl` hold every frame; `.tum` or `.txt` (TUM RGB-D), `.chan` (Nuke), `.gltf` and `.glb` those with a pose.
/// Warns where the format cannot hold all of the camera. Throws as check_track_format and write_text_file, and Error where a
/// format of poses would hold none.
void write_track(const std::string& path, const std::vector<TrackRow>& rows, const Shot& shot, bool overwrite,
                 const WarningHandler& warn);

}  // namespace catchlight::app
