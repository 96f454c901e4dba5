// Runs `tune` by scripts on a copy of a shipped recording.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {

inline std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The recording is a copy, so that its scene may be saved.
class TunedRecording : public ::testing::Test {
 protected:
  TunedRecording() {
    for (const char* name : {"video.mp4", "camera.yaml", "scene.toml", "object.glb", "probe.exr"})
      std::filesystem::copy_file(std::string(CATCHLIGHT_SOURCE_DIR) + "/recordings/matte/" + name, folder_.path(name));
  }

  std::string path(const std::string& name) const { return folder_.path(name); }
  std::string folder() const { return std::filesystem::path(folder_.path("x")).parent_path().string(); }

  CommandResult run(const std::string& script) {
    return run_catchlight({"tune", folder(), "--headless", "--ui-script", folder_.write("script.txt", script)});
  }

  TemporaryFolder folder_;
};

}  // namespace catchlight::tests
