// Files that are there completely or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace catchlight {

/// An empty file beside its target, for a writer to fill: hidden, with the target's extension and a name of its own, so that
/// two writers of one target do not meet. commit() renames it; without that it is removed.
class PendingFile {
 public:
  /// Throws Error where nothing can be written beside `target`: before the work rather than after it.
  explicit PendingFile(std::filesystem::path target);
  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&&) = delete;
  ~PendingFile();

  std::string pending_path() const { return pending_.string(); }

  /// Puts the file under its name, replacing what is there. Throws Error.
  void commit();

 private:
  std::filesystem::path target_, pending_;  // pending_ is empty once committed or moved from
};

}  // namespace catchlight
