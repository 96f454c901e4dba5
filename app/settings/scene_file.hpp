// Reads scene.toml.
#pragma once

#include <string>

#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// Keys and checks are those of parameters.hpp; `[[object]]` may be repeated, and an object's `tag_from_object` is
/// `{ translation_m, rotation_deg, scale }` or `{ matrix = 3 rows of 4 }`.
/// Throws Error "file:line:column: ..." for what is not TOML, unknown keys (naming the nearest known one), wrong types and values
/// out of range.
SceneSettings read_scene_file(const std::string& path);

}  // namespace catchlight::app
