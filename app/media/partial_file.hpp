// A file that gets its name only when it is complete. Private to app/media.
#pragma once

#include <filesystem>

namespace catchlight::app {

/// Written as `.name.partial.ext` in the folder of `path` (same extension, since muxers go by it); removed unless commit() is
/// called.
class PartialFile {
 public:
  /// Throws Error where the folder is missing or cannot be written to.
  explicit PartialFile(std::filesystem::path path);
  ~PartialFile();
  PartialFile(PartialFile&& other) noexcept;
  PartialFile& operator=(PartialFile&&) = delete;

  const std::filesystem::path& final_path() const { return final_; }
  const std::filesystem::path& partial_path() const { return partial_; }

  /// Puts the file under its name, replacing what is there. Throws Error.
  void commit();

 private:
  std::filesystem::path final_, partial_;  // partial_ is empty once committed or moved from
};

}  // namespace catchlight::app
