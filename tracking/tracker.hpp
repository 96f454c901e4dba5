// Finds one AprilTag in each frame and says where it is. No GL, no video.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "catchlight.hpp"

namespace catchlight::tracking {

/// A luma plane as the decoder gave it: 8-bit codes, row-major, `stride` bytes a row.
/// `black_code` and `white_code` are the codes of 0 and 1 (16 and 235 in limited range, 0 and 255 in full range).
struct LumaView {
  const std::uint8_t* data = nullptr;
  int width_px = 0, height_px = 0, stride = 0;
  double black_code = 0, white_code = 255;
  TransferFunction transfer = TransferFunction::srgb;
};

/// The printed tag. `size_m` is the side of the square whose corners detectors return.
struct TagTarget {
  std::string family = "tag36h11";
  int id = 0;
  double size_m = 0.08;
};

enum class TrackState {
  tracking,  ///< seen in this frame
  coasting,  ///< not seen; the pose is predicted from the last frames
  lost       ///< no pose
};

/// One frame's result. Corners are in tag order (-,-) (+,-) (+,+) (-,+), in OpenCV's pixel convention, as seen (distorted).
struct TagObservation {
  TrackState state = TrackState::lost;
  RigidTransform camera_from_tag;
  std::array<glm::dvec2, 4> corners_px{};
  double reprojection_rms_px = 0;  ///< of the four corners under the chosen pose
  double ambiguity = 0;            ///< chosen pose's reprojection error over the other's: 0 clear, 1 both fit alike
  int hamming = 0;                 ///< corrected bits
};

struct TrackerOptions {
  int max_hamming = 1;
  double quad_decimate = 1.0;
  int threads = 2;
  double coast_s = 0.2;  ///< how long a lost tag's pose is predicted
};

/// Every family the AprilTag library has, by the names it is known by.
const std::vector<std::string>& tag_families();

/// Stateful: remembers the last frames to choose between the two planar poses and to coast.
/// Throws Error for an unknown family (naming those there are) and for a luma plane of another size than the camera's.
class Tracker {
 public:
  Tracker(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// Frames come in order; `time_s` never decreases.
  TagObservation track(const LumaView& luma, double time_s);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catchlight::tracking
