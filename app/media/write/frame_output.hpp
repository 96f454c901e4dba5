// Where finished frames go: an encoder, EXR layers, or a comparison with truth.
#pragma once

#include <memory>
#include <string>

#include "app/media/pixels/frame.hpp"
#include "app/media/read/source.hpp"
#include "app/media/write/sink.hpp"
#include "catchlight/composite.hpp"

namespace catchlight::app {

class FrameOutput {
 public:
  virtual ~FrameOutput() = default;

  /// Frames that are not wanted are tracked, but neither drawn nor written.
  virtual bool wants_frame(std::int64_t /*number*/) const { return true; }

  /// Whether write() needs composite.layers.
  virtual bool wants_layers() const { return false; }

  /// `composite.rect` is empty where nothing virtual reached the frame: it passes through as it is.
  virtual void write(const Frame& plate, const Composite& composite) = 0;

  /// Puts the result under its name.
  virtual void finish() {}
};

/// `%04d.exr` becomes EXR layers, anything else goes through MediaSink.
std::unique_ptr<FrameOutput> open_output(const std::string& path, const std::string& source_location, const MediaSource& source,
                                         const SinkOptions& options);

}  // namespace catchlight::app
