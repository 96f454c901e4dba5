#include "app/settings/parameters.hpp"

namespace catchlight::app {
namespace {

constexpr const char* kIntroduction = R"(# Parameters of a scene

Made by `catchlight params --markdown`; a test holds this page equal to its output.

Every parameter is a key of the scene file and an option of the commands that take a recording: `streak_strength = 0.1`
under `[glare]`, or `--glare.streak_strength 0.1`. An option overrides the scene file, and the scene file overrides the
default.

In the scene file `[[object]]` may be repeated, and so may `[[tag.bundle]]`, for the further tags of a board. As
options, their keys mean the only one, or with a number, counted from 0, any: `--object.mesh a.glb`,
`--object[1].tag_from_object.scale 2`. `tag_from_object` is a table, `{ translation_m = [x, y, z], rotation_deg = [x, y,
z], scale = s }`, or `{ matrix = [[...], [...], [...]] }`, 3 rows of 4. Options write three numbers as `0.8,0.8,0.8`.
File names are relative to the scene file; in options, to the working folder.

**Cost** is what a change asks to be done again, in a shot that is open:

| cost | what is made again |
|---|---|
| `view` | nothing that is kept: the next frame is drawn with it |
| `passes` | the compositor's passes |
| `light` | the probe and what is made of it: lights, harmonics and reflections; the bake too where the probe shows the receiver's albedo |
| `bake` | the transfer, and the light that is split by its bands |
| `mesh` | the objects' meshes in their places, and what is baked on them |
| `track` | the track: every frame is looked at again |
| `footage` | the footage, whose codes stand for other light, and its track |
)";

std::string section_of(const Parameter& parameter) {
  return parameter.key.substr(0, parameter.key.find('.'));
}

/// Before the first section: keys that stand in none.
bool is_in_section(const Parameter& parameter) {
  return parameter.key.find('.') != std::string::npos;
}

/// The default as it would stand in the scene file.
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
              "\n\n| key | default | expected | cost | meaning |\n|---|---|---|---|---|\n";
    }
    page += "| `" + (is_in_section(parameter) ? parameter.key.substr(section.size() + 1) : parameter.key) + "` | " +
            shown_default(parameter) + " | " + expected_text(parameter) + " | " + name_of(parameter.cost) + " | " +
            parameter.help + " |\n";
  }
  return page;
}

}  // namespace catchlight::app
