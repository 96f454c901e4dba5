// Parameters as options of the command line: what their text means, and which object or further tag they speak of.
#include <algorithm>
#include <filesystem>

#include "app/settings/parameters.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

/// What a scene may have several of, with the words of messages.
struct List {
  const char* name;  ///< what the rows' keys begin with
  const char *owner, *one, *several;
};
constexpr List kLists[] = {{"object", "the scene", "object", "objects"},
                           {"tag.bundle", "the board", "further tag", "further tags"}};

/// Null for a row that stands for one value.
const List* list_of(const Parameter& parameter) {
  const auto found =
      std::ranges::find_if(kLists, [&](const List& list) { return parameter.key.starts_with(std::string(list.name) + '.'); });
  return found == std::end(kLists) ? nullptr : found;
}

/// A row and, where the key says it, which object or further tag.
struct NamedElement {
  const Parameter* parameter;
  std::optional<std::size_t> index;
};

std::optional<NamedElement> element_named(const std::string& key) {
  if (const Parameter* parameter = find_parameter(key)) return NamedElement{parameter, std::nullopt};
  const std::size_t open = key.find('['), close = key.find(']');
  if (open == std::string::npos || close == std::string::npos || close < open) return std::nullopt;
  const auto index = integer_from_text(key.substr(open + 1, close - open - 1));
  const Parameter* parameter = find_parameter(key.substr(0, open) + key.substr(close + 1));
  if (!parameter || !index || *index < 0) return std::nullopt;
  const List* list = list_of(*parameter);
  if (!list || key.substr(0, open) != list->name) return std::nullopt;
  return NamedElement{parameter, static_cast<std::size_t>(*index)};
}

/// Which one is meant: the one that the key names, or the only one. Throws UsageError where there is no such one, or several.
std::size_t chosen_index(const SceneSettings& settings, const std::string& key, const NamedElement& named) {
  const List* list = list_of(*named.parameter);
  if (!list) return 0;
  const std::size_t count = element_count(settings, *named.parameter);
  const std::string there_are =
      "--" + key + ": " + list->owner + " has " + std::to_string(count) + ' ' + (count == 1 ? list->one : list->several);
  const auto option = [&](std::size_t index) { return "--" + element_key(*named.parameter, index); };
  if (named.index && *named.index < std::max<std::size_t>(count, 1)) return *named.index;
  if (named.index)
    throw UsageError(there_are + (count < 2 ? ", which is " + option(0) : ", from " + option(0) + " to " + option(count - 1)));
  if (count > 1)
    throw UsageError(there_are + "; change the one you mean in the scene file, or by its number: " + option(0) + " to " +
                     option(count - 1));
  return 0;
}

std::optional<ParameterValue> vector_from_text(const std::string& text) {
  const std::vector<std::string> fields = split(text, ',');
  if (fields.size() != 3) return std::nullopt;
  glm::dvec3 v;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> component = real_from_text(fields[static_cast<std::size_t>(i)]);
    if (!component) return std::nullopt;
    v[i] = *component;
  }
  return v;
}

std::optional<ParameterValue> flag_from_text(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return std::nullopt;
}

/// What `text` stands for under each kind; empty where it stands for nothing.
struct FromText {
  const std::string& text;
  using Value = std::optional<ParameterValue>;

  Value operator()(const RealKind&) const { return real_from_text(text); }
  Value operator()(const IntegerKind&) const { return integer_from_text(text); }
  Value operator()(const FlagKind&) const { return flag_from_text(text); }
  Value operator()(const SwitchKind&) const { return flag_from_text(text); }
  Value operator()(const VectorKind&) const { return vector_from_text(text); }
  Value operator()(const PathKind& kind) const {
    if (text.empty() || kind.is_word(text)) return std::nullopt;
    return std::filesystem::absolute(text).string();
  }
  Value operator()(const WordKind&) const { return std::nullopt; }
  Value operator()(const ChoiceKind&) const { return std::nullopt; }
};

}  // namespace

std::string element_key(const Parameter& parameter, std::size_t index) {
  const List* list = list_of(parameter);
  if (!list) return parameter.key;
  const std::string name = list->name;
  return name + '[' + std::to_string(index) + ']' + parameter.key.substr(name.size());
}

bool names_an_element(const std::string& key) {
  const auto named = element_named(key);
  return named && named->index;
}

void set_parameter_from_text(SceneSettings& settings, const std::string& key, const std::string& text) {
  const auto named = element_named(key);
  if (!named) throw UsageError("--" + key + ": there is no such parameter; `catchlight params` lists them");
  const Parameter& parameter = *named->parameter;
  const std::size_t index = chosen_index(settings, key, *named);
  if (parameter.key.starts_with("object.tag_from_object.") && index < settings.objects.size() && settings.objects[index].matrix)
    throw UsageError("--" + key +
                     ": the scene file places the object by a matrix; give it translation_m, rotation_deg and scale there");
  const ParameterValue value = std::visit(FromText{text}, parameter.kind).value_or(text);
  try {
    set_parameter(settings, parameter, value, index);
  } catch (const Error& error) {
    throw UsageError("--" + key + std::string(error.what()).substr(parameter.key.size()));
  }
}

}  // namespace catchlight::app
