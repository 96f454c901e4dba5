// Files that are there completely or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace catchlight::app {

/// Throws UsageError where `path` exists and `overwrite` is false, Error where its folder does not.
void check_output_path(const std::string& path, bool overwrite);

/// Writes beside `path` and renames. Throws as check_output_path, and Error where writing fails; then nothing is left behind.
void write_text_file(const std::string& path, std::string_view text, bool overwrite);

/// A name beside `path`, with its extension, for a writer that needs a name; renamed by commit(), deleted otherwise.
class PendingFile {
 public:
  /// Throws as check_output_path.
  PendingFile(const std::string& path, bool overwrite);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  std::string pending_path() const { return pending_.string(); }
  void commit();

 private:
  std::filesystem::path path_, pending_;
};

}  // namespace catchlight::app
