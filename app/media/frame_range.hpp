// Which frames of the footage are wanted.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace catchlight::app {

/// Half-open range of frame numbers, as `--frames A:B` says.
struct FrameRange {
  std::int64_t begin = std::numeric_limits<std::int64_t>::min();
  std::int64_t end = std::numeric_limits<std::int64_t>::max();
  bool contains(std::int64_t number) const { return number >= begin && number < end; }
};

/// "A:B" (B left out of it), "A:" or ":B"; "N" is that frame alone. The empty text is every frame. Throws UsageError;
/// numbers below 0 are refused, as they would mean the end's to those who know them from Python.
FrameRange parse_frame_range(const std::string& text);

}  // namespace catchlight::app
