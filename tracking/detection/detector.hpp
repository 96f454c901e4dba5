// The AprilTag library's detector behind one owner, its conventions turned into the project's.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "catchlight/luma_view.hpp"
#include "tracking/tracker_options.hpp"

namespace catchlight::tracking {

struct Detection {
  int id = 0;
  int hamming = 0;
  double decision_margin = 0;              ///< mean distance of the bits from the decision threshold, in luma codes
  std::array<glm::dvec2, 4> corners_px{};  ///< (-,-) (+,-) (+,+) (-,+) in the tag frame; OpenCV's pixel convention
  std::size_t family = 0;                  ///< index into those that the detector was made with
};

/// The library returns corners from the tag's bottom left, counter-clockwise as the tag is read, which is our order;
/// its pixel (0, 0) is the corner of the first pixel, OpenCV's is the centre.
std::array<glm::dvec2, 4> corners_from_library(const double (&library_corners)[4][2]);

class Detector {
 public:
  /// Throws Error for an unknown family or an option out of range.
  Detector(const std::string& family, const TrackerOptions& options);
  Detector(const std::vector<std::string>& families, const TrackerOptions& options);
  ~Detector();
  Detector(Detector&&) noexcept;
  Detector& operator=(Detector&&) noexcept;

  /// Edges are sought in a picture made `decimate` times smaller (from 1 to 8), bits read in the full one. On the calling
  /// thread, in an order that depends on nothing but the picture.
  std::vector<Detection> detect(const LumaView& luma, double decimate = 1);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catchlight::tracking
