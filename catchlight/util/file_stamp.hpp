// Whether a file is still the one that it was.
#pragma once

#include <string>

namespace catchlight {

/// A text that is another where the file has another path, size or date, without reading it.
std::string file_stamp(const std::string& path);

}  // namespace catchlight
