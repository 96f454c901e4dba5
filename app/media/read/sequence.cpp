#include "app/media/read/sequence.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace catchlight::app {

std::optional<SequencePattern> SequencePattern::parse(const std::string& path) {
  const std::filesystem::path whole(path);
  const std::string name = whole.filename().string();
  const std::size_t percent = name.find('%');
  if (percent == std::string::npos) return {};
  std::size_t end = percent + 1;
  while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end]))) ++end;
  if (end == name.size() || name[end] != 'd' || name.find('%', end) != std::string::npos) return {};

  SequencePattern pattern;
  if (end > percent + 1) {
    if (name[percent + 1] != '0') return {};  // "%4d" pads with spaces
    const auto [rest, error] = std::from_chars(name.data() + percent + 1, name.data() + end, pattern.digits_);
    if (error != std::errc() || pattern.digits_ == 0 || pattern.digits_ > 18) return {};
  }
  pattern.folder_ = whole.has_parent_path() ? whole.parent_path() : ".";
  pattern.before_ = name.substr(0, percent);
  pattern.after_ = name.substr(end + 1);
  return pattern;
}

std::filesystem::path SequencePattern::file(std::int64_t number) const {
  std::string digits = std::to_string(number);
  if (digits.size() < digits_) digits.insert(0, digits_ - digits.size(), '0');
  return folder_ / (before_ + digits + after_);
}

std::optional<std::int64_t> SequencePattern::number_of(const std::string& file_name) const {
  if (file_name.size() <= before_.size() + after_.size()) return {};
  if (!file_name.starts_with(before_) || !file_name.ends_with(after_)) return {};
  const std::string digits = file_name.substr(before_.size(), file_name.size() - before_.size() - after_.size());
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 0) return {};
  // "0012" is no file of "%d", "12" none of "%04d".
  if (file(number).filename() != file_name) return {};
  return number;
}

std::vector<std::int64_t> SequencePattern::existing() const {
  std::vector<std::int64_t> numbers;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    if (const auto number = number_of(entry.path().filename().string())) numbers.push_back(*number);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace catchlight::app
