// The header of PLY files, and the values behind it, text or binary.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catchlight::render {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count_type;  ///< of lists only
};

struct PlyElement {
  std::string name;
  std::size_t count;
  std::vector<PlyProperty> properties;
};

/// A PLY file, read from its beginning to its end: the header at once, then value by value.
class PlyValues {
 public:
  /// Throws Error naming the file: what is no PLY, or what its header says wrongly. No element has more rows than the file has
  /// room for.
  explicit PlyValues(const std::string& path);

  const std::vector<PlyElement>& elements() const { return elements_; }
  const std::vector<std::string>& comments() const { return comments_; }

  /// The next value. Throws Error where the file ends.
  double next(PlyType type);

  /// The next list's length, of which there are so many values left in the file at least.
  std::size_t next_count(PlyType type, PlyType of);

  /// Throws Error: file, and what is wrong.
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  enum class Format { ascii, little_endian, big_endian };

  std::string_view header_line();
  void read_header();
  void read_format(const std::vector<std::string>& words);
  void read_property(const std::vector<std::string>& words);
  PlyType type_named(const std::string& name) const;
  std::size_t least_bytes(PlyType type) const;
  void check_counts() const;
  double next_word();

  std::string path_, bytes_;
  std::size_t at_ = 0;
  std::optional<Format> format_;
  std::vector<PlyElement> elements_;
  std::vector<std::string> comments_;
};

}  // namespace catchlight::render
