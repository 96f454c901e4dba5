#include "app/media/read/sequence.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace catchlight::app {
namespace {

constexpr std::size_t kMaxDigits = 18;

struct NumberField {
  std::size_t begin, end, digits;
};

/// C's `%d` or `%04d`.
std::optional<NumberField> percent_field(const std::string& name) {
  NumberField field{name.find('%'), name.find('%') + 1, 1};
  while (field.end < name.size() && std::isdigit(static_cast<unsigned char>(name[field.end]))) ++field.end;
  if (field.end == name.size() || name[field.end] != 'd' || name.find('%', field.end) != std::string::npos) return {};
  if (field.end > field.begin + 1) {
    if (name[field.begin + 1] != '0') return {};  // "%4d" pads with spaces
    const auto [rest, error] = std::from_chars(name.data() + field.begin + 1, name.data() + field.end, field.digits);
    if (error != std::errc() || field.digits == 0 || field.digits > kMaxDigits) return {};
  }
  ++field.end;
  return field;
}

/// Nuke's `####`. One `#` alone may be part of a name.
std::optional<NumberField> hash_field(const std::string& name) {
  const std::size_t begin = name.find("##");
  if (begin == std::string::npos) return {};
  const std::size_t end = std::min(name.find_first_not_of('#', begin), name.size());
  if (end - begin > kMaxDigits || name.find("##", end) != std::string::npos) return {};
  return NumberField{begin, end, end - begin};
}

}  // namespace

std::optional<SequencePattern> SequencePattern::parse(const std::string& path) {
  const std::filesystem::path whole(path);
  const std::string name = whole.filename().string();
  const std::optional<NumberField> field = name.find('%') != std::string::npos ? percent_field(name) : hash_field(name);
  if (!field) return {};
  SequencePattern pattern;
  pattern.digits_ = field->digits;
  pattern.folder_ = whole.has_parent_path() ? whole.parent_path() : ".";
  pattern.before_ = name.substr(0, field->begin);
  pattern.after_ = name.substr(field->end);
  return pattern;
}

std::string SequencePattern::printf_path() const {
  return (folder_ / (before_ + "%0" + std::to_string(digits_) + "d" + after_)).string();
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
