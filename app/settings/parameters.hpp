// Every parameter of a scene, described once: from this table come the scene file's keys and their checks, the command line's
// options, docs/parameters.md, and whatever else shows or sets a parameter.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// The part of an opened shot that a parameter belongs to. What is made from that part follows it.
enum class ChangeCost {
  view,    ///< nothing that is kept: the next frame is drawn with it
  passes,  ///< the compositor's passes
  light,   ///< the probe and what is made of it: lights, harmonics, reflections, and the receiver's albedo where it shows that
  bake,    ///< the transfer, and the light that is split by its bands
  mesh,    ///< the objects' meshes in their places
  track,   ///< the track: every frame is looked at again
  footage  ///< the footage: its codes stand for other light
};

/// Where a value lives, in scenes that may change and in those that may not. It is made from a lambda,
/// `[](auto& s) { return &s.probe.ev; }`, or for what a scene has several of,
/// `[](auto& s, std::size_t i) { return &s.objects[i].scale; }`.
template <class T>
class Access {
 public:
  template <class Get>
  Access(Get)
      : held_([](const SceneSettings& settings, std::size_t i) -> const T* { return at<Get>(settings, i); }),
        changed_([](SceneSettings& settings, std::size_t i) -> T* { return at<Get>(settings, i); }) {}

  const T& operator()(const SceneSettings& settings, std::size_t index) const { return *held_(settings, index); }
  T& operator()(SceneSettings& settings, std::size_t index) const { return *changed_(settings, index); }

 private:
  template <class Get, class Settings>
  static auto at(Settings& settings, [[maybe_unused]] std::size_t index) {
    if constexpr (std::is_invocable_v<Get, Settings&>)
      return Get{}(settings);
    else
      return Get{}(settings, index);
  }

  const T* (*held_)(const SceneSettings&, std::size_t);
  T* (*changed_)(SceneSettings&, std::size_t);
};

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
  ChangeCost cost;
  std::string help;
  ParameterKind kind;
};

/// In the order of the documentation: grouped by the key's first part.
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

/// set_parameter from text as an option gives it: `0.5`, `true`, `auto`, `0.8,0.8,0.8`. Throws UsageError naming `--KEY`: unknown
/// key, or what set_parameter refuses.
void set_parameter_from_text(SceneSettings& settings, const std::string& key, const std::string& text);

/// The present value, as set_parameter_from_text reads it; the default where there is no such object or further tag.
std::string parameter_text(const SceneSettings& settings, const Parameter& parameter, std::size_t index = 0);

/// The value of a path parameter as the file system needs it; one of its words as it is.
std::string word_or_path(const SceneSettings& settings, const std::string& key);

/// "number from 0 to 1 in m", "\"match\" or \"fixed\"", ...
std::string expected_text(const Parameter& parameter);

/// The reference in docs/parameters.md.
std::string parameters_markdown();

}  // namespace catchlight::app
