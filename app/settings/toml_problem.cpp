#include "app/settings/toml_problem.hpp"

#include <algorithm>
#include <array>

namespace catchlight::app {
namespace {

struct Problem {
  std::string_view theirs;  ///< a part of toml++'s description
  std::string_view ours;    ///< %: what the description has in quotes
};

/// The first that fits counts.
constexpr std::array kProblems{
    Problem{"utf-8", "is not UTF-8 text; save it as UTF-8"},
    Problem{"unknown escape sequence",
            "a backslash in double quotes is an escape; write file names with / or in single quotes: 'C:\\shots\\robot.glb'"},
    Problem{"control characters", "the closing quote is missing on this line"},
    Problem{"could not determine value type", "expected a value: a number, true, false, or text in quotes"},
    Problem{"expected value, saw", "expected a value, found %"},
    Problem{"existing table", "the table % is there already; put all of its keys under its first heading"},
    Problem{"cannot redefine existing", "the key % is there already; leave one of the two out"},
    Problem{"whitespace, saw ','", "expected the end of the line, found ','; decimals are written with a point: 0.08"},
    Problem{"expected a comment or whitespace, saw", "expected the end of the line, found %"},
    Problem{"expected decimal digit, saw '.'", "a number begins with a digit: 0.08"},
    Problem{"expected '=', saw", "expected key = value, found %"},
    Problem{"expected ']', saw", "expected ], as in [tag] or [[object]], found %"},
    Problem{"expected keys, tables", "expected TOML, found %"},
};

/// The last text in single quotes; what people call a character that has no picture.
std::string quoted(std::string_view description) {
  const std::size_t end = description.rfind('\'');
  if (end == std::string_view::npos || end == 0) return "something else";
  const std::size_t begin = description.rfind('\'', end - 1);
  const std::string_view found = description.substr(begin, end - begin + 1);
  if (found == "'\\n'" || found == "'\\r'") return "the end of the line";
  if (found.starts_with("'\\u")) return "what is no text";
  return std::string(found);
}

}  // namespace

std::string toml_problem(std::string_view description) {
  const auto known = std::ranges::find_if(
      kProblems, [&](const Problem& problem) { return description.find(problem.theirs) != std::string_view::npos; });
  if (known == kProblems.end()) {
    const std::size_t colon = description.find(": ");
    return "is not TOML: " + std::string(description.substr(colon == std::string_view::npos ? 0 : colon + 2));
  }
  std::string text(known->ours);
  if (const std::size_t at = text.find('%'); at != std::string::npos) text.replace(at, 1, quoted(description));
  return text;
}

}  // namespace catchlight::app
