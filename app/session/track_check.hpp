// Whether a track file belongs to a shot.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "app/media/read/source.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/tag.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {

class TrackCheck {
 public:
  /// Throws Error where the file says that another tag was tracked, or by another camera: one of another size, or one that sees
  /// something of the picture more than a pixel elsewhere. Warns where it has rows of frames beside the footage's. A file that
  /// does not say (bare poses) belongs to every shot.
  TrackCheck(std::string path, const tracking::TrackFile& file, const CameraModel& camera, const PrintedTag& tag,
             const SourceInfo& footage, WarningHandler warn);

  /// Takes each frame that is wanted. Warns once, of the first whose time is half a frame's interval or more off its row's.
  void see(std::int64_t frame, double time_s);

  /// "; track.csv has no row for 3 of them, the first of which is frame 7", or nothing.
  std::string missing_rows() const;

 private:
  std::string path_;
  std::map<std::int64_t, double> times_s_;  ///< the rows'
  bool has_times_ = false;
  double half_interval_s_ = 0;
  WarningHandler warn_;
  std::int64_t missing_ = 0, first_missing_ = 0;
};

/// The greatest distance, over the picture, between where the two cameras of one size see the same thing; in pixels.
double distance_px(const CameraModel& one, const CameraModel& other);

}  // namespace catchlight::app
