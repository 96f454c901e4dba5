// Values for parameters, whatever their kind.
#pragma once

#include <string>
#include <variant>

#include "app/settings/parameters.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::tests {

/// A value that the parameter takes and that is not its default, where it has two.
inline std::string other_value(const app::Parameter& parameter) {
  const std::string present = app::parameter_text(app::SceneSettings{}, parameter);
  if (const auto* real = std::get_if<app::RealKind>(&parameter.kind)) return plain_text(real->min);
  if (const auto* integer = std::get_if<app::IntegerKind>(&parameter.kind))
    return std::to_string(std::to_string(integer->max) == present ? integer->min : integer->max);
  if (std::holds_alternative<app::FlagKind>(parameter.kind)) return present == "true" ? "false" : "true";
  if (std::holds_alternative<app::SwitchKind>(parameter.kind)) return "false";
  if (std::holds_alternative<app::VectorKind>(parameter.kind)) return "0.25,0.5,0.75";
  if (const auto* choice = std::get_if<app::ChoiceKind>(&parameter.kind)) return choice->choices.back();
  if (const auto* word = std::get_if<app::WordKind>(&parameter.kind)) return word->choices.back();
  return "/somewhere/file";
}

}  // namespace catchlight::tests
