// Shared libraries that are loaded only when they are needed. Private to app/media.
#pragma once

#include <string>

namespace catchlight::app {

/// A library that few runs need and that brings many others: libavfilter alone takes a third of the program's time to start. It
/// stays loaded.
class LateLibrary {
 public:
  /// `file_name`: with the version that the headers are of. Throws Error where it is not installed.
  explicit LateLibrary(const std::string& file_name);

  /// The library's function of that name: `Function` is its type. Throws Error where it has none.
  template <typename Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(address(name));
  }

 private:
  void* address(const char* name) const;

  std::string file_name_;
  void* handle_;
};

}  // namespace catchlight::app
