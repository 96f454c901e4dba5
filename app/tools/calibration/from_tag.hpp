// A first camera from footage of a single tag.
#pragma once

#include <string>

#include "app/media/frame_range.hpp"
#include "app/media/read/source.hpp"
#include "app/support/log.hpp"
#include "catchlight/camera.hpp"
#include "tracking/camera/focal_length.hpp"

namespace catchlight::app {

struct CameraFromTag {
  CameraModel camera;  ///< square pixels, principal point in the middle, no distortion
  tracking::FocalEstimate focal_length;
};

/// Throws Error where the tag is not in the footage, or where its views do not tell the focal length. `name` is the footage's.
CameraFromTag camera_from_tag(MediaSource& source, const std::string& name, const std::string& family, int id,
                              const FrameRange& range, Log& log);

/// What the user is told of it.
std::string camera_from_tag_text(const CameraFromTag& result);

}  // namespace catchlight::app
