#include "render/mesh_file/text_lines.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::render {
namespace {

constexpr std::string_view kBlank = " \t\r";

}  // namespace

TextLines::TextLines(const std::string& path) : path_(path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot be opened");
  text_.assign(std::istreambuf_iterator<char>(in), {});
}

bool TextLines::next() {
  words_.clear();
  while (words_.empty() && at_ < text_.size()) {
    line_ += 1 + lines_joined_;
    lines_joined_ = 0;
    const std::size_t start = at_;
    for (bool goes_on = true; goes_on;) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      const std::size_t last = text_.find_last_not_of(kBlank, end - 1);
      goes_on = end < text_.size() && end > at_ && last != std::string::npos && last >= at_ && text_[last] == '\\';
      if (goes_on) std::fill(text_.begin() + last, text_.begin() + end + 1, ' '), ++lines_joined_;
      at_ = end + 1;
    }
    std::string_view line(text_.data() + start, std::min(at_ - 1, text_.size()) - start);
    line = line.substr(0, line.find('#'));
    for (std::size_t from = line.find_first_not_of(kBlank); from != std::string_view::npos;) {
      const std::size_t to = std::min(line.find_first_of(kBlank, from), line.size());
      words_.push_back(line.substr(from, to - from));
      from = line.find_first_not_of(kBlank, to);
    }
  }
  return !words_.empty();
}

std::string_view TextLines::rest() const {
  if (words_.size() < 2) return {};
  return {words_[1].data(), static_cast<std::size_t>(words_.back().data() + words_.back().size() - words_[1].data())};
}

double TextLines::number(std::size_t index) const {
  if (index >= words_.size()) refuse("\"" + std::string(words_[0]) + "\" is followed by too few numbers");
  std::string_view word = words_[index];
  if (word.starts_with('+')) word.remove_prefix(1);
  const std::optional<double> value = real_from_text(word);
  if (!value || !std::isfinite(*value)) refuse("\"" + std::string(words_[index]) + "\" is not a finite number");
  return *value;
}

void TextLines::refuse(const std::string& why) const {
  throw Error(path_ + ":" + std::to_string(line_) + ": " + why);
}

}  // namespace catchlight::render
