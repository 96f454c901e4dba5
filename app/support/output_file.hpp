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

/// An empty file beside `path`, with its extension, for a writer to fill; renamed by commit(), removed otherwise.
class PendingFile {
 public:
  /// Throws as check_output_path, and Error where nothing can be written there: before the work rather than after it.
  PendingFile(const std::string& path, bool overwrite);
  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&&) = delete;
  ~PendingFile();

  std::string pending_path() const { return pending_.string(); }

  /// Puts the file under its name, replacing what is there. Throws Error.
  void commit();

 private:
  std::filesystem::path path_, pending_;  // pending_ is empty once committed or moved from
};

}  // namespace catchlight::app
