// A run that was kept: what recordings are held against whose truth is not known.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "catchlight/track.hpp"

namespace catchlight::app {

/// How far two pictures of a frame are apart where at least one of them changes the plate: of each pixel the largest difference
/// of its channels' codes, of 255.
struct KeptDifference {
  double mean = 0, p99 = 0;
};

/// All 8-bit BGR of one size. No difference where neither changes the plate.
KeptDifference compare_with_kept(const cv::Mat& ours, const cv::Mat& kept, const cv::Mat& plate);

/// The folder `baseline` of a recording: track.csv, and pictures of some frames as %04d.png.
class Baseline {
 public:
  explicit Baseline(const std::string& recording_folder);

  bool is_kept() const;
  const std::string& track_file() const { return track_file_; }
  std::string picture(std::int64_t frame) const;
  bool has_picture(std::int64_t frame) const;

  /// Keeps the track anew. The frames whose pictures are there stay chosen; where none is, the first, the middle and the last
  /// frame with a pose become so. Returns the chosen frames, whose pictures are to be kept next. Throws Error where no frame has
  /// a pose, and as write_text_file.
  std::vector<std::int64_t> keep(const std::vector<TrackRow>& rows) const;

 private:
  std::string folder_, track_file_;
};

}  // namespace catchlight::app
