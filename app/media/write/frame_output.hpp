// The output of finished frames: an encoder or EXR layers.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/media/pixels/frame.hpp"
#include "app/media/read/source.hpp"
#include "app/media/write/layer_style.hpp"
#include "app/media/write/sink.hpp"
#include "catchlight/composite.hpp"

namespace catchlight::app {

class FrameOutput {
 public:
  virtual ~FrameOutput() = default;

  /// Without pixels in the composite, as where nothing virtual reached the frame, it passes through as it is.
  /// `camera_from_tag`: where the frame has a pose.
  virtual void write(const Frame& plate, const Composite& composite, const std::optional<RigidTransform>& camera_from_tag) = 0;

  /// Puts the result under its name.
  virtual void finish() {}
};

/// Whether an output of that name is layers for compositing packages (`.exr`), which write() needs in composite.layers.
bool holds_layers(const std::string& path);

/// `%04d.exr` becomes EXR layers, anything else goes through MediaSink.
std::unique_ptr<FrameOutput> open_output(const std::string& path, const std::string& source_location, const MediaSource& source,
                                         const SinkOptions& options, const LayerOptions& layers = {});

}  // namespace catchlight::app
