// Names of numbered image files: `shot.%04d.png`, `shot.####.png`, `img_%d.jpg`. Private to app/media.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace catchlight::app {

/// A path whose file name holds one `%d` or `%0Nd`, or as many `#` (two or more) as there are digits.
class SequencePattern {
 public:
  /// None where there is no such field, or more than one.
  static std::optional<SequencePattern> parse(const std::string& path);

  std::filesystem::path folder() const { return folder_; }

  /// The same path with `%0Nd`, for FFmpeg.
  std::string printf_path() const;

  /// The path of one file; negative numbers have none.
  std::filesystem::path file(std::int64_t number) const;

  /// The number in a file's name, where the name is one the pattern makes.
  std::optional<std::int64_t> number_of(const std::string& file_name) const;

  /// Numbers of the files there are, ascending.
  std::vector<std::int64_t> existing() const;

 private:
  std::filesystem::path folder_;
  std::string before_, after_;
  std::size_t digits_ = 1;
};

}  // namespace catchlight::app
