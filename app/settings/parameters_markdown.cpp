#include "app/settings/parameters.hpp"

namespace catchlight::app {
namespace {

constexpr const char* kIntroduction =
    "# Parameters of a scene\n"
    "\n"
    "Made by `catchlight params --markdown`; a test holds this page equal to its output.\n"
    "\n"
    "Every parameter is a key of the scene file and an option of the commands that take a recording: `streak_strength = 0.1` "
    "under\n"
    "`[glare]`, or `--glare.streak_strength 0.1`. Options go before the scene file, the scene file before the defaults.\n"
    "\n"
    "In the scene file `[[object]]` may be repeated; as options its keys speak of the only object; so may `[[tag.bundle]]`, for "
    "the "
    "further tags of a board. `tag_from_object` is a "
    "table,\n"
    "`{ translation_m = [x, y, z], rotation_deg = [x, y, z], scale = s }`, or `{ matrix = [[...], [...], [...]] }`, 3 rows of "
    "4.\n"
    "Options write three numbers as `0.8,0.8,0.8`. File names are relative to the scene file; in options, to the working "
    "folder.\n";

std::string section_of(const Parameter& parameter) {
  return parameter.key.substr(0, parameter.key.find('.'));
}

/// Before the first section: keys that stand in none.
bool is_in_section(const Parameter& parameter) {
  return parameter.key.find('.') != std::string::npos;
}

/// As it would stand in the scene file.
std::string shown_default(const Parameter& parameter) {
  const std::string text = parameter_text(SceneSettings{}, parameter);
  if (text.empty()) return "none";
  if (std::holds_alternative<VectorKind>(parameter.kind)) {
    std::string list = "`[";
    for (const char c : text) list += c == ',' ? ", " : std::string(1, c);
    return list + "]`";
  }
  const bool is_text =
      std::holds_alternative<ChoiceKind>(parameter.kind) || std::holds_alternative<WordKind>(parameter.kind) || text == "auto";
  return is_text ? "`\"" + text + "\"`" : '`' + text + '`';
}

}  // namespace

std::string parameters_markdown() {
  std::string page = kIntroduction, section;
  for (const Parameter& parameter : parameters()) {
    if (section_of(parameter) != section) {
      section = section_of(parameter);
      const std::string heading = section == "object" ? "`[[object]]`" : "`[" + section + "]`";
      page += "\n## " + (is_in_section(parameter) ? heading : "Before the first section") +
              "\n\n| key | default | expected | meaning |\n|---|---|---|---|\n";
    }
    page += "| `" + (is_in_section(parameter) ? parameter.key.substr(section.size() + 1) : parameter.key) + "` | " +
            shown_default(parameter) + " | " + expected_text(parameter) + " | " + parameter.help + " |\n";
  }
  return page;
}

}  // namespace catchlight::app
