// EXR sequences for compositing packages.
#pragma once

#include <memory>
#include <string>

#include "app/media/write/frame_output.hpp"

namespace catchlight::app {

/// `pattern` has one %d field, filled with the frame's number. Channels as docs/conventions.md lists them.
/// Throws UsageError, at the frame in question, where a file exists and `overwrite` is false.
std::unique_ptr<FrameOutput> open_exr_layers(const std::string& pattern, bool overwrite);

}  // namespace catchlight::app
