// The track file: the whole interface between tracking and rendering. CSV, one row a frame, the first line names the columns;
// docs/track-formats.md describes them all. r_ij is row i, column j of camera_from_tag's rotation; t is in metres. Lost frames
// (found 0) have empty pose cells. What the track is of stands in columns of its own, the same in every row.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"

namespace catchlight::tracking {

/// What was tracked, and by which camera; its vignetting is not in the file.
struct TrackSubject {
  CameraModel camera;
  PrintedTag tag;
};

struct TrackFile {
  std::vector<TrackRow> rows;
  std::optional<TrackSubject> subject;  ///< empty where the file does not say
  bool has_times = false;
};

/// Columns are found by name; `frame` is needed, and r00 .. tz unless every row has found 0. A file without the others (known
/// poses) reads too: found, tracking, without exposure. So does what spreadsheets write: a byte-order mark; semicolons, with
/// which decimal commas go. Throws Error "file:line: ..." for what is malformed, not a rotation (more than 1e-3 off orthonormal
/// or mirrored), not finite, or not in rising order of frames.
TrackFile read_track_file(const std::string& path);

/// Every number is the shortest text that reads back to the same bits.
std::string track_file_text(const std::vector<TrackRow>& rows, const std::optional<TrackSubject>& subject = {});

}  // namespace catchlight::tracking
