// The track file: the whole interface between tracking and rendering. CSV, one row a frame, the first line names the columns:
//   frame,time_s,found,r00,r01,r02,r10,...,r22,tx,ty,tz,state,exposure_r,...,black_b,corner_sigma_px,ambiguity,
//   blur_xx_px2,blur_xy_px2,blur_yy_px2,noise_codes,noise_slope_r,...,noise_floor_b,noise_correlation_rg,_rb,_gb,
//   turn_x,turn_y,turn_z,shift_x,shift_y,shift_z,shutter,focus_px2
// r_ij is row i, column j of camera_from_tag's rotation; t is in metres. Lost frames (found 0) have empty pose cells.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "catchlight/track.hpp"

namespace catchlight::tracking {

/// Columns are found by name; `frame` is needed, and r00 .. tz unless every row has found 0. A file without the others (known
/// poses) reads too: found, tracking, without exposure. Throws Error "file:line: ..." for what is malformed, not a rotation (more
/// than 1e-3 off orthonormal or mirrored), not finite, or not in rising order of frames.
std::vector<TrackRow> read_track_file(const std::string& path);

/// Every number is the shortest text that reads back to the same bits.
std::string track_file_text(const std::vector<TrackRow>& rows);

}  // namespace catchlight::tracking
