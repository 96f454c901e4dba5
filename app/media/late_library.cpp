#include "app/media/late_library.hpp"

#include <dlfcn.h>

#include "catchlight/error.hpp"

namespace catchlight::app {

LateLibrary::LateLibrary(const std::string& file_name)
    : file_name_(file_name), handle_(dlopen(file_name.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (!handle_) throw Error(file_name + ": cannot be loaded (" + dlerror() + "); install FFmpeg's libraries");
}

void* LateLibrary::address(const char* name) const {
  void* found = dlsym(handle_, name);
  if (!found) throw Error(file_name_ + ": has no function " + name + "; install FFmpeg's libraries of the version built with");
  return found;
}

}  // namespace catchlight::app
