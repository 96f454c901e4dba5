#include "catchlight/util/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

namespace catchlight {
namespace {

template <class Number>
std::optional<Number> number_from_text(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return value;
}

}  // namespace

std::string number_text(double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string plain_text(double value) {
  std::array<char, 512> buffer;  // DBL_MAX has 309 digits
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed);
  return {buffer.data(), result.ptr};
}

std::string fixed_text(double value, int digits) {
  std::array<char, 512> buffer;  // DBL_MAX has 309 digits
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, digits);
  return {buffer.data(), result.ptr};
}

std::string length_text(double length_m) {
  const double length_mm = length_m * 1000;
  return length_mm < 999.5 ? fixed_text(length_mm, length_mm < 9.95 ? 1 : 0) + " mm" : fixed_text(length_m, 2) + " m";
}

std::optional<double> real_from_text(std::string_view text) {
  return number_from_text<double>(text);
}

std::optional<std::int64_t> integer_from_text(std::string_view text) {
  return number_from_text<std::int64_t>(text);
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> fields(1);
  for (const char c : text) {
    if (c == separator)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

std::string quoted_list(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) list += i + 1 == words.size() ? " or " : ", ";
    list += '"' + words[i] + '"';
  }
  return list;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string tail = '.' + std::string(word.substr(word.rfind('.') + 1));
  const auto distance = [&](const std::string& candidate) {
    const std::size_t edits = edit_distance(word, candidate);
    return candidate.ends_with(tail) ? std::min<std::size_t>(edits, 1) : edits;
  };
  return *std::min_element(candidates.begin(), candidates.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
}

}  // namespace catchlight
