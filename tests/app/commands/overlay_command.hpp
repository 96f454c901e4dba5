// Runs `overlay` on copies of the shipped recordings.
#pragma once

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "render/probe/probe.hpp"
#include "render/probe/probe_layouts.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {

inline std::string recording(const std::string& name = "matte") {
  return CATCHLIGHT_SOURCE_DIR "/recordings/" + name;
}

inline void run_shell(const std::string& command) {
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// Few rays and bands: these tests are not about light.
inline std::vector<std::string> quick(std::vector<std::string> arguments) {
  for (const char* option : {"--quality.rays=64", "--quality.bands=2", "--quality.bounces=0", "--quality.receiver_points=16",
                             "--quality.reflection_rays=0", "--quality.samples=1", "--preset=ultrafast"})
    arguments.push_back(option);
  return arguments;
}

class OverlayCommand : public ::testing::Test {
 protected:
  /// The shipped recording in a folder of its own, for tests that spoil it. Its footage is `frames` frames long; its probe is
  /// small, as filtering a large one is most of what a short run costs.
  std::string copied_recording(int frames = 6, const std::string& name = "matte") {
    const std::string copy = folder_.path("recording"), original = recording(name);
    std::filesystem::create_directories(copy);
    for (const char* file : {"camera.yaml", "scene.toml", "object.glb"})
      std::filesystem::copy(original + "/" + file, copy + "/" + file);
    const render::Probe probe = render::load_probe(original + "/probe.exr", {}, {});
    render::save_probe(copy + "/probe.exr", render::convert(probe, render::ProbeLayout::latlong, 64));
    run_shell("ffmpeg -v error -nostdin -i " + original + "/video.mp4 -frames:v " + std::to_string(frames) + " -c copy " + copy +
              "/video.mp4");
    return copy;
  }

  void replace_in(const std::string& path, const std::string& from, const std::string& to) {
    std::string text = read_text(path);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(path) << text.replace(at, from.size(), to);
  }

  CommandResult overlay(const std::string& location, const std::string& output, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"overlay", location, "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_catchlight(quick(arguments), {{"XDG_CACHE_HOME", folder_.path("cache")}});
  }

  /// Exit code 1, one message that holds all of `parts`, and nothing left in the output's place.
  void expect_refused(const CommandResult& result, const std::string& output, const std::vector<std::string>& parts,
                      int exit_code = 1) {
    EXPECT_EQ(result.exit_code, exit_code) << result.error;
    EXPECT_THAT(result.error, ::testing::HasSubstr("catchlight: error: "));
    for (const std::string& part : parts) EXPECT_THAT(result.error, ::testing::HasSubstr(part));
    EXPECT_FALSE(std::filesystem::exists(output));
    EXPECT_EQ(result.output, "");
  }

  TemporaryFolder folder_;
  std::string out_ = folder_.path("out.mkv");
};

}  // namespace catchlight::tests
