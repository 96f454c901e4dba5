#include "catchlight/util/pending_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include "catchlight/error.hpp"

namespace catchlight {
namespace {

namespace fs = std::filesystem;

/// A name in the same folder, so that renaming never copies, with the extension, which writers go by. It is random: process
/// numbers would not tell writers on two machines apart.
fs::path random_name_beside(const fs::path& target) {
  const std::string partial = ".partial-" + std::to_string(std::random_device()());
  return target.parent_path() / ('.' + target.stem().string() + partial + target.extension().string());
}

/// False, with errno, where the file cannot be made or is there already.
bool create_new(const fs::path& path) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  return file >= 0 && close(file) == 0;
}

}  // namespace

PendingFile::PendingFile(fs::path target) : target_(std::move(target)) {
  fs::path pending = random_name_beside(target_);
  while (!create_new(pending)) {
    if (errno != EEXIST)
      throw Error(target_.string() + ": cannot write into its folder: " + std::strerror(errno) + "; choose another place");
    pending = random_name_beside(target_);
  }
  pending_ = std::move(pending);
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : target_(std::move(other.target_)), pending_(std::exchange(other.pending_, {})) {}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!pending_.empty()) fs::remove(pending_, ignored);
}

void PendingFile::commit() {
  std::error_code error;
  fs::rename(pending_, target_, error);
  if (error) throw Error(target_.string() + ": cannot be put in place: " + error.message());
  pending_.clear();
}

}  // namespace catchlight
