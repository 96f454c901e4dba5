#include "app/media/frame_range.hpp"

#include <charconv>
#include <string_view>

#include "catchlight/error.hpp"

namespace catchlight::app {
namespace {

std::int64_t parse_frame_number(std::string_view text, const std::string& whole) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw UsageError("--frames " + whole + ": expected A:B, A:, :B or N (frame numbers; B itself is left out)");
  if (number < 0)
    throw UsageError("--frames " + whole +
                     ": no frame has a number below 0; give the numbers of frames, not how far from the end");
  return number;
}

}  // namespace

FrameRange parse_frame_range(const std::string& text) {
  FrameRange range;
  if (text.empty()) return range;
  const std::size_t colon = text.find(':');
  const std::string_view view(text);
  if (colon == std::string::npos) {
    range.begin = parse_frame_number(view, text);
    range.end = range.begin + 1;
    return range;
  }
  if (colon > 0) range.begin = parse_frame_number(view.substr(0, colon), text);
  if (colon + 1 < text.size()) range.end = parse_frame_number(view.substr(colon + 1), text);
  if (range.begin >= range.end) throw UsageError("--frames " + text + ": the range is empty; expected A:B with A below B");
  return range;
}

}  // namespace catchlight::app
