// Notices files that were saved anew by another program.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace catchlight::app {

/// Files as they were when they were last looked at. One that is missing may come, and is a change when it does.
class FileWatch {
 public:
  /// Watches these from now on, and no others. What was known of those that were watched before stays.
  void watch(const std::vector<std::string>& paths);

  /// The files that have changed since they were told, or first watched. One that is still being written, so that it changes from
  /// look to look, is told when it has come to rest. A look at a file takes microseconds.
  std::set<std::string> take_changed();

 private:
  struct Stamps {
    std::string told, seen;
  };
  std::map<std::string, Stamps> stamps_;  ///< by the file's path
};

}  // namespace catchlight::app
