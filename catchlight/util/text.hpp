// Small things with text that several parsers and messages share.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catchlight {

/// The shortest text that reads back to the same bits.
std::string number_text(double value);

/// The same number for people: never an exponent.
std::string plain_text(double value);

/// The number with that many digits after the point, never an exponent.
std::string fixed_text(double value, int digits);

/// "83 mm" below a metre, "8.3 mm" below a centimetre, else "1.25 m".
std::string length_text(double length_m);

/// The whole of `text` as a number, else empty. No leading '+' or spaces; "inf" and "nan" are numbers here.
std::optional<double> real_from_text(std::string_view text);
std::optional<std::int64_t> integer_from_text(std::string_view text);

/// "a,b,,c" gives four fields; the empty text gives one.
std::vector<std::string> split(std::string_view text, char separator);

/// "1 frame", "12 frames", "0 frames"; `several` where more is to be done than to add an s.
template <std::integral Count>
std::string counted(Count count, const std::string& one, const std::string& several = {}) {
  return std::to_string(count) + ' ' + (count == 1 ? one : several.empty() ? one + 's' : several);
}

/// `"a", "b" or "c"`.
std::string quoted_list(const std::vector<std::string>& words);

/// Levenshtein's distance: insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate of least distance; one that ends in `.word` is nearer than any other. Needs at least one candidate.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace catchlight
