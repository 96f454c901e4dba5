// Every parameter of a scene, described once: from this table come the scene file's keys and their checks, the command line's
// options, docs/parameters.md, and whatever else shows or sets a parameter.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// Where a value lives. Rows named `object.*` mean the scene's last object, `tag.bundle.*` the board's last tag.
template <class T>
using Access = T& (*)(SceneSettings&);

struct RealKind {
  Access<double> access;
  double min, max;
};
struct IntegerKind {
  Access<int> access;
  int min, max;
};
struct FlagKind {
  Access<bool> access;
};
struct TextKind {
  Access<std::string> access;
};
struct PathKind {
  Access<std::string> access;           ///< relative to the scene file; on the command line, to the working folder
  std::vector<std::string> words = {};  ///< that stand for themselves; of one with a colon, what follows it is an example
  bool is_word(const std::string& text) const;
};
struct ChoiceKind {
  Access<std::string> access;
  std::vector<std::string> choices;
};
struct SwitchKind {
  Access<Switch> access;
};
struct VectorKind {
  Access<glm::dvec3> access;
  double min, max;  ///< of each component
};
using ParameterKind = std::variant<RealKind, IntegerKind, FlagKind, TextKind, PathKind, ChoiceKind, SwitchKind, VectorKind>;

struct Parameter {
  std::string key;   ///< "glare.streak_strength"
  std::string unit;  ///< "m", "deg", "EV", ...; empty: a plain number, or not a number
  std::string help;
  ParameterKind kind;
};

/// In the order of the documentation: grouped by the key's first part.
const std::vector<Parameter>& parameters();

/// Null where there is none of that name.
const Parameter* find_parameter(const std::string& key);

/// What a file or an option can give.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string, glm::dvec3>;

/// Checks type, range and choice, stores, and notes in `by_hand`. Throws Error: "KEY is 3 ...; expected ..." without saying
/// where. An `object.*` or `tag.bundle.*` key makes the first one where there is none.
void set_parameter(SceneSettings& settings, const Parameter& parameter, const ParameterValue& value);

/// set_parameter from text as an option gives it: `0.5`, `true`, `auto`, `0.8,0.8,0.8`. Throws UsageError naming `--KEY`: unknown
/// key, or what set_parameter refuses.
void set_parameter_from_text(SceneSettings& settings, const std::string& key, const std::string& text);

/// The present value, as set_parameter_from_text reads it.
std::string parameter_text(const SceneSettings& settings, const Parameter& parameter);

/// The value of a path parameter as the file system needs it; one of its words as it is.
std::string word_or_path(const SceneSettings& settings, const std::string& key);

/// "number from 0 to 1 in m", "\"match\" or \"fixed\"", ...
std::string expected_text(const Parameter& parameter);

/// The reference in docs/parameters.md.
std::string parameters_markdown();

}  // namespace catchlight::app
