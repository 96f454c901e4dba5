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

#include "app/photometry/lens_model.hpp"
#include "catchlight.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::app {

struct TrackRow {
  std::int64_t frame = 0;
  double time_s = 0;
  bool found = false;
  RigidTransform camera_from_tag;
  tracking::TrackState state = tracking::TrackState::lost;
  bool has_exposure = false;  ///< false: a bare pose, as poses.csv has them
  glm::dvec3 exposure{1.0};   ///< exposed linear value of white paper on the tag, per unit of albedo (docs/conventions.md)
  glm::dvec3 black{0.0};
  double corner_sigma_px = 0;      ///< how uncertain the tag's corners are in the picture, per axis
  double ambiguity = 0;            ///< probability that the other planar pose is the right one
  tracking::Covariance2 blur_px2;  ///< of the tag's edges, by lens, motion and pixel; 0: not measured
  double noise_codes = 0;          ///< on the tag, in 8-bit codes; 0: not measured
  NoiseModel noise;                ///< of the whole footage, where it was recorded; all 0: not measured
  LensBlurModel lens_blur;         ///< the last parts of blur_px2, taken apart
};

/// As the files say it: "tracking", "coasting", "lost".
const char* name_of(tracking::TrackState state);

/// Columns are found by name; `frame` is needed, and r00 .. tz unless every row has found 0. A file without the others (known
/// poses) reads too: found, tracking, without exposure. Throws Error "file:line: ..." for what is malformed, not a rotation (more
/// than 1e-3 off orthonormal or mirrored), not finite, or not in rising order of frames.
std::vector<TrackRow> read_track_file(const std::string& path);

/// Every number is the shortest text that reads back to the same bits.
std::string track_file_text(const std::vector<TrackRow>& rows);

}  // namespace catchlight::app
