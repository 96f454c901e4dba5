// The lines of mesh files that are text.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catchlight::render {

/// Goes through a text line by line, word by word. Words are separated by spaces and tabs; `#` begins a comment; a backslash at
/// the end goes on in the next line.
class TextLines {
 public:
  /// Throws Error where the file cannot be read.
  explicit TextLines(const std::string& path);

  /// To the next line that has a word; false after the last.
  bool next();

  /// The line's words; the first is there.
  const std::vector<std::string_view>& words() const { return words_; }

  /// All behind the first word, as a name that may hold spaces.
  std::string_view rest() const;

  /// Word `index` as a finite number. Throws Error where there is none.
  double number(std::size_t index) const;

  /// Throws Error: file and line, and what is wrong.
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  std::string path_, text_;
  std::size_t at_ = 0;
  int line_ = 0, lines_joined_ = 0;
  std::vector<std::string_view> words_;
};

}  // namespace catchlight::render
