#include "app/support/output_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "catchlight/error.hpp"

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

/// In the same folder, so that renaming never copies; hidden; with the extension, which writers go by. Another process may write
/// the same file at the same time.
fs::path pending_path_for(const fs::path& path) {
  const std::string partial = ".partial-" + std::to_string(getpid());
  return path.parent_path() / ('.' + path.stem().string() + partial + path.extension().string());
}

}  // namespace

void check_output_path(const std::string& path, bool overwrite) {
  const fs::path folder = fs::path(path).parent_path();
  if (path.empty()) throw UsageError("the name of the output file is empty");
  if (fs::is_directory(path)) throw UsageError(path + ": is a folder; give the name of a file to write");
  if (!folder.empty() && !fs::is_directory(folder))
    throw Error(path + ": there is no folder " + folder.string() + "; make it first, or choose another output");
  if (!overwrite && fs::exists(path))
    throw UsageError(path + ": exists already; pass -y to overwrite it, or choose another output");
}

void write_text_file(const std::string& path, std::string_view text, bool overwrite) {
  PendingFile pending(path, overwrite);
  std::ofstream file(pending.pending_path(), std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) throw Error(path + ": cannot be written; is its folder writable and the disk not full?");
  pending.commit();
}

PendingFile::PendingFile(const std::string& path, bool overwrite) : path_(path) {
  check_output_path(path, overwrite);
  const fs::path pending = pending_path_for(path_);
  errno = 0;
  if (!std::ofstream(pending, std::ios::binary | std::ios::trunc))
    throw Error(path + ": cannot write into its folder: " + std::strerror(errno) + "; choose another output");
  pending_ = pending;
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)), pending_(std::exchange(other.pending_, {})) {}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!pending_.empty()) fs::remove(pending_, ignored);
}

void PendingFile::commit() {
  std::error_code error;
  fs::rename(pending_, path_, error);
  if (error) throw Error(path_.string() + ": cannot be put in place: " + error.message());
  pending_.clear();
}

}  // namespace catchlight::app
