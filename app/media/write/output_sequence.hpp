// What can be known of the files of a sequence before they are written. Private to app/media.
#pragma once

#include <string>

#include "app/media/read/sequence.hpp"
#include "app/media/read/source.hpp"
#include "app/media/write/sink.hpp"

namespace catchlight::app {

/// Throws before the work what the work would end in: UsageError where a file that will be written exists and may not be
/// replaced (the first is named), or is the footage's own; Error where the folder is missing or nothing can be written there.
/// How many frames there are is not always known; then every file from the first frame on counts.
void check_output_sequence(const SequencePattern& pattern, const std::string& source_location, const SourceInfo& source,
                           const SinkOptions& options);

}  // namespace catchlight::app
