// Small things with text that several parsers and messages share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catchlight {

/// The shortest text that reads back to the same bits.
std::string number_text(double value);

/// The number with that many digits after the point, never an exponent.
std::string fixed_text(double value, int digits);

/// The whole of `text` as a number, else empty. No leading '+' or spaces; "inf" and "nan" are numbers here.
std::optional<double> real_from_text(std::string_view text);
std::optional<std::int64_t> integer_from_text(std::string_view text);

/// "a,b,,c" gives four fields; the empty text gives one.
std::vector<std::string> split(std::string_view text, char separator);

/// `"a", "b" or "c"`.
std::string quoted_list(const std::vector<std::string>& words);

/// Levenshtein's distance: insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate of least distance; one that ends in `.word` is nearer than any other. Needs at least one candidate.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace catchlight
