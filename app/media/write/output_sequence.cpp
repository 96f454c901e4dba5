#include "app/media/write/output_sequence.hpp"

#include <algorithm>

#include "app/support/output_file.hpp"

namespace catchlight::app {
namespace {

FrameRange frames_to_write(const SourceInfo& source, FrameRange range) {
  range.begin = std::max(range.begin, source.first_number);
  if (source.frame_count) range.end = std::min(range.end, source.first_number + *source.frame_count);
  return range;
}

}  // namespace

void check_output_sequence(const SequencePattern& pattern, const std::string& source_location, const SourceInfo& source,
                           const SinkOptions& options) {
  const FrameRange frames = frames_to_write(source, options.frames);
  const auto input = SequencePattern::parse(source_location);
  refuse_same_file(pattern.file(frames.begin),
                   source.is_sequence && input ? input->file(frames.begin).string() : source_location);
  check_output_path(pattern.file(frames.begin), options.overwrite);
  for (const std::int64_t number : pattern.existing()) {
    const std::filesystem::path file = pattern.file(number);
    if (frames.contains(number) && !(options.overwrite && std::filesystem::is_regular_file(file)))
      check_output_path(file, options.overwrite);
  }
}

}  // namespace catchlight::app
