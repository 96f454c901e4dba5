// Every parameter of a scene, described once: from this table come the scene file's keys and their checks, the command line's
// options, docs/parameters.md, and whatever else shows or sets a parameter.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <variant>
#include <vector>

#include "app/settings/parameter_kinds.hpp"
#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

struct Parameter {
  std::string key;   ///< "glare.streak_strength"
  std::string unit;  ///< "m", "deg", "EV", ...; empty: a plain number, or not a number
  ChangeCost cost;
  std::string help;
  ParameterKind kind;
};

/// All rows in the order of the documentation: grouped by the key's first part.
const std::vector<Parameter>& parameters();

/// Null where there is none of that name.
const Parameter* find_parameter(const std::string& key);

/// How many values a row has: 1, or for `object.*` and `tag.bundle.*` as many as there are objects and further tags.
std::size_t element_count(const SceneSettings& settings, const Parameter& parameter);

/// What a file or an option can give.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string, glm::dvec3>;

/// Checks type, range and choice, stores, and notes in `by_hand`. Throws Error: "KEY is 3 ...; expected ..." without saying
/// where. `index` says which object or further tag is meant; the first one is made where there is none.
void set_parameter(SceneSettings& settings, const Parameter& parameter, const ParameterValue& value, std::size_t index = 0);

/// set_parameter from text as an option gives it: `0.5`, `true`, `auto`, `0.8,0.8,0.8`. A key such as `object[1].mesh` says which
/// object or further tag is meant; without the number it means the only one. Throws UsageError naming `--KEY`: an unknown key,
/// one that leaves open which is meant, or what set_parameter refuses.
void set_parameter_from_text(SceneSettings& settings, const std::string& key, const std::string& text);

/// The key of one element of what a scene may have several of: `object[1].mesh`; the row's own key where there is one value.
std::string element_key(const Parameter& parameter, std::size_t index);

/// Whether the key is a row's with a number, such as `object[1].mesh`.
bool names_an_element(const std::string& key);

/// The present value, as set_parameter_from_text reads it; the default where there is no such object or further tag.
std::string parameter_text(const SceneSettings& settings, const Parameter& parameter, std::size_t index = 0);

/// The value of a path parameter as the file system needs it; one of its words as it is.
std::string word_or_path(const SceneSettings& settings, const std::string& key);

/// "number from 0 to 1 in m", "\"match\" or \"fixed\"", ...
std::string expected_text(const Parameter& parameter);

/// The reference in docs/parameters.md.
std::string parameters_markdown();

}  // namespace catchlight::app
