// A frame of footage into which the object is path-traced.
#pragma once

#include "app/session/frame_job.hpp"
#include "app/session/scene_builder.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/image.hpp"
#include "catchlight/progress.hpp"

namespace catchlight::app {

struct ReferenceQuality {
  int samples = 256;
  int bounces = 6;
};

/// The whole frame in exposed linear light, Rec. 709; where the object changes nothing it is the frame's own. The job's view is
/// set, and the tag is found in it. The receiver's own light is read from the frame, so what the camera clipped stays clipped.
/// `built` needs its files loaded.
Image trace_reference_frame(const FrameJob& job, const SceneSettings& settings, const BuiltScene& built,
                            const ReferenceQuality& quality, const ProgressHandler& progress);

/// Writes a PNG in the frame's own coding, of 8 bits a channel, or 16 where the footage has more; beside `path`, then renamed.
/// Throws Error, or UsageError where `path` exists and `overwrite` is false.
void write_reference_png(const std::string& path, const Image& exposed_linear, const Frame& frame, bool overwrite);

}  // namespace catchlight::app
