// A frame of footage with the object path traced into it.
#pragma once

#include "app/media/pixels/frame.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/progress.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

struct ReferenceQuality {
  int samples = 256;
  int bounces = 6;
};

/// Exposed linear light, Rec. 709, the whole frame: where the object changes nothing it is the frame's own. Pose and exposure are
/// those of `row`, which has found the tag. The receiver's own light is read from the frame, so what the camera clipped stays
/// clipped. Throws Error naming the file at fault.
Image trace_reference_frame(const Frame& frame, const TrackRow& row, const CameraModel& camera, const SceneSettings& scene,
                            const ReferenceQuality& quality, const WarningHandler& warn, const ProgressHandler& progress);

/// In the frame's own coding: PNG of 8 bits a channel, or 16 where the footage has more than 8. Written beside and renamed.
/// Throws Error, or UsageError where `path` exists and `overwrite` is false.
void write_reference_png(const std::string& path, const Image& exposed_linear, const Frame& frame, bool overwrite);

}  // namespace catchlight::app
