#include "app/window/editing/overlay_command.hpp"

#include "app/settings/parameters.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

void add_overrides(const RecordingOverrides& overrides, std::vector<std::string>& arguments) {
  const auto add = [&](const std::string& option, const std::string& value) {
    arguments.push_back(option), arguments.push_back(value);
  };
  if (overrides.scene_file) add("--scene", *overrides.scene_file);
  if (overrides.camera_file) add("--camera", *overrides.camera_file);
  if (overrides.fov_deg) add("--fov", number_text(*overrides.fov_deg));
  if (overrides.strict) arguments.emplace_back("--strict");
  if (overrides.renderer != Renderer::automatic) add("--renderer", name_of(overrides.renderer));
  if (!overrides.shader_folder.empty()) add("--shader-dir", overrides.shader_folder);
}

}  // namespace

std::vector<std::string> overlay_arguments(const std::string& location, const RecordingOverrides& overrides,
                                           const SceneSettings& file, const SceneSettings& now, const FrameRange& range,
                                           const std::string& output) {
  std::vector<std::string> arguments{"overlay", location, "-o", output};
  add_overrides(overrides, arguments);
  for (const auto& [key, text] : overrides.parameters)
    if (const Parameter* parameter = find_parameter(key);
        !parameter || parameter_text(file, *parameter) == parameter_text(now, *parameter))
      arguments.push_back("--" + key), arguments.push_back(text);
  for (const Parameter& parameter : parameters()) {
    const std::size_t count = element_count(now, parameter);
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_changed = parameter_text(file, parameter, i) != parameter_text(now, parameter, i) ||
                              (count == 1 && now.is_by_hand(parameter.key) && !file.is_by_hand(parameter.key));
      if (!is_changed) continue;
      const bool names_a_file = std::holds_alternative<PathKind>(parameter.kind);
      arguments.push_back("--" + (count < 2 ? parameter.key : element_key(parameter, i)));
      arguments.push_back(names_a_file && count < 2 ? word_or_path(now, parameter.key) : parameter_text(now, parameter, i));
    }
  }
  const bool has_begin = range.begin != FrameRange{}.begin, has_end = range.end != FrameRange{}.end;
  if (has_begin || has_end) {
    arguments.emplace_back("--frames");
    arguments.push_back(std::to_string(range.begin) + ':' + (has_end ? std::to_string(range.end) : ""));
  }
  return arguments;
}

std::string shell_text(const std::vector<std::string>& arguments) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:=,+@%";
  std::string text;
  for (const std::string& argument : arguments) {
    if (!text.empty()) text += ' ';
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) {
      text += argument;
      continue;
    }
    text += '\'';
    for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

}  // namespace catchlight::app
