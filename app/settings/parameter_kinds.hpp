// The kinds of values that parameters have, where the values live, and what a change of them costs.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "app/settings/scene_settings.hpp"
#include "catchlight/util/enum_names.hpp"

namespace catchlight::app {

/// The part of an opened shot that a parameter belongs to, and that a change asks to be made again with all that follows from it
/// (docs/parameters.md).
enum class ChangeCost {
  view,    ///< nothing that is kept: the next frame is drawn with it
  passes,  ///< the compositor's passes
  light,   ///< the probe and what is made of it: lights, harmonics, reflections, and the receiver's albedo where it shows that
  bake,    ///< the transfer, and the light that is split by its bands
  mesh,    ///< the objects' meshes in their places
  track,   ///< the track: every frame is looked at again
  footage  ///< the footage: its codes stand for other light
};
constexpr auto names_of(ChangeCost) {
  return std::array{"view", "passes", "light", "bake", "mesh", "track", "footage"};
}

/// Asks a lambda such as `[](auto& s) { return &s.probe.ev; }` where a value lives; for what a scene has several of it is
/// `[](auto& s, std::size_t i) { return &s.objects[i].scale; }`.
template <class Get, class Settings>
auto place_of(Settings& settings, [[maybe_unused]] std::size_t index) {
  if constexpr (std::is_invocable_v<Get, Settings&>)
    return Get{}(settings);
  else
    return Get{}(settings, index);
}

/// The place of a value, in scenes that may change and in those that may not; made from such a lambda.
template <class T>
class Access {
 public:
  template <class Get>
  Access(Get)
      : held_([](const SceneSettings& settings, std::size_t i) -> const T* { return place_of<Get>(settings, i); }),
        changed_([](SceneSettings& settings, std::size_t i) -> T* { return place_of<Get>(settings, i); }) {}

  const T& operator()(const SceneSettings& settings, std::size_t index) const { return *held_(settings, index); }
  T& operator()(SceneSettings& settings, std::size_t index) const { return *changed_(settings, index); }

 private:
  const T* (*held_)(const SceneSettings&, std::size_t);
  T* (*changed_)(SceneSettings&, std::size_t);
};

/// How a slider goes over a range.
enum class Scale {
  linear,
  logarithmic,
  angle,  ///< degrees, which come round to where they began
  color   ///< linear red, green and blue
};

struct RealKind {
  Access<double> access;
  double min, max;
  Scale scale = Scale::linear;
  double floor = 0;  ///< where a logarithmic scale begins if min is 0, with min itself below it
};
struct IntegerKind {
  Access<int> access;
  int min, max;
  Scale scale = Scale::linear;
};
struct FlagKind {
  Access<bool> access;
};
struct SwitchKind {
  Access<Switch> access;
};
struct VectorKind {
  Access<glm::dvec3> access;
  double min, max;  ///< bounds of each component
  Scale scale = Scale::linear;
};

struct PathKind {
  Access<std::string> access;           ///< relative to the scene file; on the command line, to the working folder
  std::vector<std::string> words = {};  ///< that stand for themselves; of one with a colon, what follows it is an example
  bool is_word(const std::string& text) const;
};

/// A word of a list that is not the program's own.
struct WordKind {
  Access<std::string> access;
  std::vector<std::string> choices;
};

/// How choices are written: an enum by its names; one that may be left to the program is "auto" where it is.
template <NamedEnum Enum>
std::vector<std::string> choices_of(Enum) {
  return name_list<Enum>();
}
template <NamedEnum Enum>
std::vector<std::string> choices_of(std::optional<Enum>) {
  std::vector<std::string> choices = name_list<Enum>();
  choices.insert(choices.begin(), "auto");
  return choices;
}
template <NamedEnum Enum>
std::string choice_name(std::optional<Enum> choice) {
  return choice ? name_of(*choice) : "auto";
}
template <NamedEnum Enum>
void choose(Enum& chosen, const std::string& name) {
  chosen = value_named<Enum>(name).value();
}
template <NamedEnum Enum>
void choose(std::optional<Enum>& chosen, const std::string& name) {
  chosen = value_named<Enum>(name);
}

/// A value of an enum, of whichever, with the lambda of its place.
struct ChoiceKind {
  template <class Get>
  explicit ChoiceKind(Get)
      : choices(choices_of(std::remove_cvref_t<decltype(*place_of<Get>(std::declval<SceneSettings&>(), 0))>{})),
        held(
            [](const SceneSettings& settings, std::size_t i) { return choice_name(std::optional(*place_of<Get>(settings, i))); }),
        set([](SceneSettings& settings, std::size_t i, const std::string& name) { choose(*place_of<Get>(settings, i), name); }) {}

  std::vector<std::string> choices;
  std::string (*held)(const SceneSettings&, std::size_t index);
  void (*set)(SceneSettings&, std::size_t index, const std::string& choice);  ///< one of `choices`
};

using ParameterKind = std::variant<RealKind, IntegerKind, FlagKind, SwitchKind, VectorKind, PathKind, WordKind, ChoiceKind>;

}  // namespace catchlight::app
