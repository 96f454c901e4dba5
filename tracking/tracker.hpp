// Finds a tag, or a board of them, in each frame and says where it is. No GL, no video.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
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

/// A printed tag. `size_m` is the side of the square whose corners detectors return.
struct PrintedTag {
  std::string family = "tag36h11";
  int id = 0;
  double size_m = 0.08;
  bool operator==(const PrintedTag&) const = default;
};

/// A further tag of a board, fixed to the first.
struct BundledTag : PrintedTag {
  RigidTransform tag_from_this;
};

/// What is tracked: a tag, whose frame is the tag frame, alone or as the first of a board.
struct TagTarget : PrintedTag {
  std::vector<BundledTag> bundle;

  /// The first tag (in its own frame) and the bundle.
  std::vector<BundledTag> tags() const;
};

/// Covariance of a two-dimensional spread, such as the camera's blur in px².
struct Covariance2 {
  double xx = 0, xy = 0, yy = 0;
};

/// Covariance of a pose, row-major 6x6: a small rotation (rad) about the camera's x, y, z axes through the tag's origin, then a
/// translation (m) in the camera frame.
using PoseCovariance = std::array<double, 36>;

enum class TrackState {
  tracking,  ///< seen in this frame
  coasting,  ///< not seen; the pose is predicted from the last frames
  lost       ///< no pose
};

/// A pose that one frame allows.
struct PoseCandidate {
  RigidTransform camera_from_tag;
  PoseCovariance covariance{};
  double log_likelihood = 0;  ///< comparable among the candidates of one frame
};

/// What the camera made of the tag's print, from direct refinement.
struct TagAppearance {
  double white_linear = 0, black_linear = 0;  ///< luma made linear, in the tag's middle; 1 = sensor white
  Covariance2 blur_px2;                       ///< of lens, motion and pixel together
  double noise_codes = 0;                     ///< standard deviation, 8-bit codes
  double covered_share = 0;                   ///< of the tag, by something else
};

/// One frame's result. Corners are in tag order (-,-) (+,-) (+,+) (-,+), in OpenCV's pixel convention, as seen (distorted).
struct TagObservation {
  TrackState state = TrackState::lost;
  RigidTransform camera_from_tag;
  PoseCovariance covariance{};
  std::array<glm::dvec2, 4> corners_px{};   ///< of the first tag
  double corner_sigma_px = 0;               ///< how uncertain they are, per axis
  double ambiguity = 0;                     ///< probability that the other planar pose is the right one
  std::vector<PoseCandidate> candidates;    ///< one or two, the likelier first; empty unless tracking
  std::optional<TagAppearance> appearance;  ///< where the frame was refined directly
};

/// What follows detection, from cheap to exact.
enum class Refinement {
  none,     ///< the detector's corners
  corners,  ///< its four edges, fitted in linear light
  direct    ///< the whole pattern
};

struct TrackerOptions {
  Refinement refinement = Refinement::direct;
  int max_hamming = 1;
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
