// Holds the camera that was given against the tag's own perspective.
#pragma once

#include "app/session/recording.hpp"
#include "app/support/log.hpp"
#include "catchlight/camera.hpp"
#include "tracking/camera/focal_length.hpp"

namespace catchlight::app {

/// Says what the tag's views say of the focal length, and warns where the camera's is more than 3 % off, beyond doubt.
void tell_focal_length(const tracking::FocalEstimate& seen, const CameraModel& camera, const Recording& recording, Log& log);

}  // namespace catchlight::app
