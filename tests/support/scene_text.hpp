// Scene files from texts.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "app/settings/scene_file.hpp"
#include "catchlight/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {

inline app::SceneSettings read_scene(const std::string& text) {
  const TemporaryFolder folder;
  return app::read_scene_file(folder.write("scene.toml", text));
}

/// What is said about a scene that is refused, after the file's name.
inline std::string scene_refusal(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.write("scene.toml", text);
  const std::string message = message_of<Error>([&] { app::read_scene_file(path); });
  EXPECT_THAT(message, ::testing::StartsWith(path + ':'));
  return message.substr(std::min(message.size(), path.size() + 1));
}

}  // namespace catchlight::tests
