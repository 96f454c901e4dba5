// What one frame says of its exposure: its tag's white and black, and the surface around them.
#pragma once

#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/frame_image.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tracking/camera/exposure.hpp"
#include "tracking/camera/plane_light.hpp"

namespace catchlight::tracking {

struct ExposureReading {
  double time_s = 0;
  TagReading own;
  BundledTag tag;                   ///< that was read
  std::optional<PlaneLight> plane;  ///< empty where no tag was read

  bool knows(int channel) const { return own.sources[static_cast<std::size_t>(channel)] == ExposureSource::tag; }
  bool is_guessed() const;  ///< in some channel the black cells alone say how bright white is
};

class ExposureReader {
 public:
  ExposureReader(const CameraModel& camera, const TagTarget& target, const TagAlbedo& albedo)
      : camera_(camera), target_(target), albedo_(albedo) {}

  /// The row has its pose and state. A pose that was only predicted may not lie on the cells: nothing is read there. Of a board,
  /// the first tag that can be read without clipping is read, else the first that can be read.
  ExposureReading read(const FrameImage& frame, const TrackRow& row) const;

 private:
  CameraModel camera_;
  TagTarget target_;
  TagAlbedo albedo_;
};

}  // namespace catchlight::tracking
