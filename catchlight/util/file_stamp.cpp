#include "catchlight/util/file_stamp.hpp"

#include <filesystem>

namespace catchlight {

std::string file_stamp(const std::string& path) {
  std::error_code missing;
  const auto changed = std::filesystem::last_write_time(path, missing).time_since_epoch().count();
  return path + '|' + std::to_string(std::filesystem::file_size(path, missing)) + '|' + std::to_string(changed) + '\n';
}

}  // namespace catchlight
