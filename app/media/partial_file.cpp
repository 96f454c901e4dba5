#include "app/media/partial_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "catchlight.hpp"

namespace catchlight::app {

namespace fs = std::filesystem;

PartialFile::PartialFile(fs::path path) : final_(std::move(path)) {
  const fs::path folder = final_.has_parent_path() ? final_.parent_path() : ".";
  if (!fs::is_directory(folder))
    throw Error("cannot write '" + final_.string() + "': there is no folder '" + folder.string() + "'; make it first");
  if (fs::is_directory(final_)) throw Error("cannot write '" + final_.string() + "': it is a folder");
  partial_ = folder / std::string(".").append(final_.stem().string()).append(".partial").append(final_.extension().string());
  errno = 0;
  if (!std::ofstream(partial_, std::ios::binary | std::ios::trunc)) {
    const std::string reason = std::strerror(errno);
    throw Error("cannot write into '" + folder.string() + "' (for '" + final_.string() + "'): " + reason);
  }
}

PartialFile::~PartialFile() {
  std::error_code ignored;
  if (!partial_.empty()) fs::remove(partial_, ignored);
}

PartialFile::PartialFile(PartialFile&& other) noexcept
    : final_(std::move(other.final_)), partial_(std::exchange(other.partial_, {})) {}

void PartialFile::commit() {
  std::error_code error;
  fs::rename(partial_, final_, error);
  if (error) throw Error("cannot put the finished file at '" + final_.string() + "': " + error.message());
  partial_.clear();
}

}  // namespace catchlight::app
