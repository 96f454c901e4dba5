// Writes settings into the text of a scene file and leaves everything else in it as it is: comments, order, unknown keys.
#pragma once

#include <string>

#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// The text of a scene file that says `before`, changed so that it says `after`. Values are replaced in their places, new keys
/// go to the end of their section, and keys that `after` leaves to the program go. Objects and further tags are as many in both.
/// Throws Error "PATH:line:column: ..." for a text that is not TOML.
std::string edited_scene_text(const std::string& text, const std::string& path, const SceneSettings& before,
                              const SceneSettings& after);

/// Writes edited_scene_text of the file `from` to `to`, whole or not at all: where the disk is full, the old file stays. Throws
/// Error naming the file, also for one that is write-protected. Paths are written as `after` has them: from another folder they
/// name other files.
void save_scene_file(const std::string& from, const std::string& to, const SceneSettings& before, const SceneSettings& after);

}  // namespace catchlight::app
