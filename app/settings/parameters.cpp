#include "app/settings/parameters.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};

std::string text_of(const glm::dvec3& v) {
  return plain_text(v.x) + ',' + plain_text(v.y) + ',' + plain_text(v.z);
}

/// The text by which a message shows what was given.
std::string shown(const ParameterValue& value) {
  return std::visit(
      Overloaded{[](bool flag) { return std::string(flag ? "true" : "false"); },
                 [](std::int64_t number) { return std::to_string(number); }, [](double number) { return plain_text(number); },
                 [](const std::string& text) { return '"' + text + '"'; },
                 [](const glm::dvec3& v) { return '[' + text_of(v) + ']'; }},
      value);
}

std::string range_text(const std::string& what, const std::string& min, const std::string& max, const std::string& unit) {
  return what + " from " + min + " to " + max + (unit.empty() ? "" : " " + unit);
}

/// Whole numbers are numbers too.
std::optional<double> real_of(const ParameterValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&value)) return *real;
  return std::nullopt;
}

/// NaN is in no range.
bool in_range(double value, double min, double max) {
  return value >= min && value <= max;
}

/// Each stores `value` where it fits its kind and says whether it did.
struct Store {
  SceneSettings& settings;
  const ParameterValue& value;
  std::size_t index;

  bool operator()(const RealKind& kind) const {
    const std::optional<double> real = real_of(value);
    if (!real || !in_range(*real, kind.min, kind.max)) return false;
    kind.access(settings, index) = *real;
    return true;
  }
  bool operator()(const IntegerKind& kind) const {
    const auto* integer = std::get_if<std::int64_t>(&value);
    if (!integer || *integer < kind.min || *integer > kind.max) return false;
    kind.access(settings, index) = static_cast<int>(*integer);
    return true;
  }
  bool operator()(const FlagKind& kind) const { return store_as<bool>(kind.access); }
  bool operator()(const PathKind& kind) const {
    const auto* path = std::get_if<std::string>(&value);
    return path && !path->empty() && store_as<std::string>(kind.access);
  }
  bool operator()(const WordKind& kind) const { return names(kind.choices) && store_as<std::string>(kind.access); }
  bool operator()(const ChoiceKind& kind) const {
    if (!names(kind.choices)) return false;
    kind.set(settings, index, std::get<std::string>(value));
    return true;
  }
  bool operator()(const SwitchKind& kind) const {
    const auto* text = std::get_if<std::string>(&value);
    const auto* flag = std::get_if<bool>(&value);
    if (!flag && !(text && *text == name_of(Switch::automatic))) return false;
    kind.access(settings, index) = !flag ? Switch::automatic : *flag ? Switch::on : Switch::off;
    return true;
  }
  bool operator()(const VectorKind& kind) const {
    const auto* v = std::get_if<glm::dvec3>(&value);
    for (int i = 0; v && i < 3; ++i)
      if (!in_range((*v)[i], kind.min, kind.max)) return false;
    return v && store_as<glm::dvec3>(kind.access);
  }

 private:
  bool names(const std::vector<std::string>& choices) const {
    const auto* text = std::get_if<std::string>(&value);
    return text && std::find(choices.begin(), choices.end(), *text) != choices.end();
  }
  template <class T>
  bool store_as(const Access<T>& access) const {
    const T* held = std::get_if<T>(&value);
    if (held) access(settings, index) = *held;
    return held != nullptr;
  }
};

bool is_of_object(const Parameter& parameter) {
  return parameter.key.starts_with("object.");
}

bool is_of_bundle(const Parameter& parameter) {
  return parameter.key.starts_with("tag.bundle.");
}

/// The defaults of every row, with one of everything that there may be several of.
const SceneSettings& defaults() {
  static const SceneSettings settings = [] {
    SceneSettings one;
    one.objects.emplace_back();
    one.tag.bundle.emplace_back();
    return one;
  }();
  return settings;
}

}  // namespace

bool PathKind::is_word(const std::string& text) const {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    const std::size_t colon = word.find(':');
    return colon == std::string::npos ? text == word : text.starts_with(word.substr(0, colon + 1));
  });
}

std::size_t element_count(const SceneSettings& settings, const Parameter& parameter) {
  if (is_of_object(parameter)) return settings.objects.size();
  return is_of_bundle(parameter) ? settings.tag.bundle.size() : 1;
}

void set_parameter(SceneSettings& settings, const Parameter& parameter, const ParameterValue& value, std::size_t index) {
  if (is_of_object(parameter) && settings.objects.empty()) settings.objects.emplace_back();
  if (is_of_bundle(parameter) && settings.tag.bundle.empty()) settings.tag.bundle.emplace_back();
  if (!std::visit(Store{settings, value, index}, parameter.kind))
    throw Error(parameter.key + " is " + shown(value) + "; expected " + expected_text(parameter));
  settings.by_hand.insert(parameter.key);
}

std::string parameter_text(const SceneSettings& settings, const Parameter& parameter, std::size_t index) {
  if (index >= element_count(settings, parameter)) return parameter_text(defaults(), parameter);
  return std::visit(Overloaded{[&](const RealKind& kind) { return plain_text(kind.access(settings, index)); },
                               [&](const IntegerKind& kind) { return std::to_string(kind.access(settings, index)); },
                               [&](const FlagKind& kind) { return std::string(kind.access(settings, index) ? "true" : "false"); },
                               [&](const SwitchKind& kind) { return name_of(kind.access(settings, index)); },
                               [&](const VectorKind& kind) { return text_of(kind.access(settings, index)); },
                               [&](const ChoiceKind& kind) { return kind.held(settings, index); },
                               [&](const auto& kind) { return kind.access(settings, index); }},
                    parameter.kind);
}

std::string word_or_path(const SceneSettings& settings, const std::string& key) {
  const Parameter& parameter = *find_parameter(key);
  const std::string value = parameter_text(settings, parameter);
  return std::get<PathKind>(parameter.kind).is_word(value) ? value : settings.resolve(value);
}

std::string expected_text(const Parameter& parameter) {
  const std::string& unit = parameter.unit;
  return std::visit(
      Overloaded{
          [&](const RealKind& kind) { return range_text("a number", plain_text(kind.min), plain_text(kind.max), unit); },
          [&](const IntegerKind& kind) {
            return range_text("a whole number", std::to_string(kind.min), std::to_string(kind.max), unit);
          },
          [](const FlagKind&) { return std::string("true or false"); },
          [](const PathKind& kind) {
            std::string words;
            for (const std::string& word : kind.words) words += '"' + word + "\", ";
            return (words.empty() ? "" : words + "or ") + "the name of a file";
          },
          [](const WordKind& kind) { return quoted_list(kind.choices); },
          [](const ChoiceKind& kind) { return quoted_list(kind.choices); },
          [](const SwitchKind&) {
            return '"' + name_of(Switch::automatic) + "\", " + name_of(Switch::on) + " or " + name_of(Switch::off);
          },
          [&](const VectorKind& kind) { return range_text("three numbers", plain_text(kind.min), plain_text(kind.max), unit); }},
      parameter.kind);
}

}  // namespace catchlight::app
