// How fast frames follow each other, as users write it.
#pragma once

#include <string>

namespace catchlight::app {

/// "25", "24000/1001", or "23.976" and the like, which mean 24000/1001. Throws UsageError.
double frame_rate_from_text(const std::string& text);

}  // namespace catchlight::app
