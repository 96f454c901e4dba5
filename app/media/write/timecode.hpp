// The timecode that footage begins with, carried on.
#pragma once

#include <string>

#include "app/media/read/source.hpp"

namespace catchlight::app {

/// The timecode of a frame by its number; empty where the footage has none, or a rate that timecodes do not know.
std::string timecode_at(const SourceInfo& source, std::int64_t number);

}  // namespace catchlight::app
