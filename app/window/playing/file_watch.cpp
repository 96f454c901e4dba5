#include "app/window/playing/file_watch.hpp"

#include <utility>

#include "catchlight/util/file_stamp.hpp"

namespace catchlight::app {

void FileWatch::watch(const std::vector<std::string>& paths) {
  std::map<std::string, Stamps> stamps;
  for (const std::string& path : paths) {
    const auto known = stamps_.find(path);
    const std::string now = known == stamps_.end() ? file_stamp(path) : "";
    stamps[path] = known == stamps_.end() ? Stamps{now, now} : known->second;
  }
  stamps_ = std::move(stamps);
}

std::set<std::string> FileWatch::take_changed() {
  std::set<std::string> changed;
  for (auto& [path, stamps] : stamps_) {
    const std::string now = file_stamp(path);
    const bool is_at_rest = std::exchange(stamps.seen, now) == now;
    if (is_at_rest && std::exchange(stamps.told, now) != now) changed.insert(path);
  }
  return changed;
}

}  // namespace catchlight::app
