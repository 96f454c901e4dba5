// A track for other programs. The extension of the file's name says the format; docs/track-formats.md has a table of them.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "app/track_export/shot.hpp"
#include "catchlight/error.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

/// Throws UsageError naming the extensions there are, where `path` has another.
void check_track_format(const std::string& path);

/// `.csv` and `.jsonl` hold every frame; `.tum` or `.txt` (TUM RGB-D), `.chan` (Nuke), `.gltf` and `.glb` those with a pose. `-`
/// is CSV on stdout. Warns where the format cannot hold all of the camera. Throws as check_track_format and write_text_file, and
/// Error where a format of poses would hold none.
void write_track(const std::string& path, const std::vector<TrackRow>& rows, const Shot& shot, bool overwrite,
                 const WarningHandler& warn);

/// What a user types into other programs' importers of this file, in one line; empty where the file says all.
std::string importer_settings(const std::string& path, const CameraModel& camera);

/// Whether a track of that name has a line a frame, which does not ask for those to come.
bool is_track_of_lines(const std::string& path);

/// A track of live footage, for programs that read along: each line is there as soon as its frame is tracked.
class TrackLines {
 public:
  /// Begins the file under its own name, or stdout. Throws as check_track_format and pending_output.
  TrackLines(const std::string& path, const Shot& shot, bool overwrite);

  /// Throws Error where nothing can be written, or nobody reads it any more.
  void write(const TrackRow& row);

 private:
  void put(const std::string& text);

  std::string path_;
  Shot shot_;
  std::size_t header_bytes_;
  std::ofstream file_;
  std::ostream& stream_;
};

}  // namespace catchlight::app
