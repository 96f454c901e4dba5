// EXR sequences for compositing packages.
#pragma once

#include <memory>
#include <string>

#include "app/media/write/frame_output.hpp"

namespace catchlight::app {

/// `pattern` has one %d field, filled with the frame's number. Channels as docs/conventions.md lists them.
/// Throws as check_output_sequence, and UsageError where the pattern has no field.
std::unique_ptr<FrameOutput> open_exr_layers(const std::string& pattern, const std::string& source_location,
                                             const SourceInfo& source, const SinkOptions& options, const LayerOptions& layers);

}  // namespace catchlight::app
