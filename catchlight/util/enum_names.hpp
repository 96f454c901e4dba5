// Names of an enum's values, as files, options and messages write them. They stand once, beside the enum:
//   enum class Weather { sunny, wet };
//   constexpr auto names_of(Weather) { return std::array{"sunny", "wet"}; }
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catchlight {

/// The values count from 0, in the order of their names.
template <class Enum>
concept NamedEnum = requires(Enum value) {
  names_of(value).size();
};

template <NamedEnum Enum>
std::string name_of(Enum value) {
  return names_of(value).at(static_cast<std::size_t>(value));
}

/// All names, in the values' order.
template <NamedEnum Enum>
std::vector<std::string> name_list() {
  const auto names = names_of(Enum{});
  return {names.begin(), names.end()};
}

/// Empty where no value has that name.
template <NamedEnum Enum>
std::optional<Enum> value_named(std::string_view name) {
  const auto names = names_of(Enum{});
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i]) return static_cast<Enum>(i);
  return std::nullopt;
}

}  // namespace catchlight
