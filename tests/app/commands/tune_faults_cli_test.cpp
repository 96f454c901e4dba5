// The window when things go wrong: nothing is lost, and it says what to do.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kRecordings = std::string(CATCHLIGHT_SOURCE_DIR) + "/recordings/";

std::vector<std::string> names_below(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(entry.path().filename().string());
  return names;
}

/// A copy of a shipped recording, so that it may be spoilt.
class TuneFaults : public ::testing::Test {
 protected:
  TuneFaults() {
    fs::create_directory(folder());
    for (const char* name : {"video.mp4", "camera.yaml", "scene.toml", "object.glb", "probe.exr"})
      fs::copy_file(kRecordings + "matte/" + name, path(name));
  }

  std::string folder() const { return files_.path("shot"); }
  std::string path(const std::string& name) const { return folder() + "/" + name; }

  std::vector<std::string> arguments(const std::string& script) const {
    return {"tune", folder(), "--headless", "--ui-script", files_.write("script.txt", script)};
  }
  CommandResult run(const std::string& script, const std::map<std::string, std::string>& environment = {}) const {
    return run_catchlight(arguments(script), environment);
  }

  TemporaryFolder files_;
};

TEST_F(TuneFaults, ClosedWhileItBakesItLeavesNoHalfFile) {
  const std::string cache = files_.path("cache");
  std::vector<std::string> slow = arguments("wait bake\nexpect stage bake\nquit\n");
  slow.insert(slow.end(), {"--quality.rays", "16384", "--renderer", "cpu"});
  const CommandResult result = run_catchlight(slow, {{"XDG_CACHE_HOME", cache}});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  for (const std::string& name : names_below(cache)) {
    EXPECT_THAT(name, Not(HasSubstr("partial")));
    EXPECT_THAT(name, Not(HasSubstr("transfer"))) << "the bake was not over";
  }
}

TEST_F(TuneFaults, ShowsTheFootageWithoutAProbeAndGoesOnWithAnother) {
  fs::remove(path("probe.exr"));
  const CommandResult result =
      run("wait\nseek 3\nwait\nexpect error " + path("probe.exr") +
          ": cannot be opened; expected a light probe (OpenEXR or Radiance HDR)\nexpect frame 3\npicture " + path("footage.png") +
          "\ndrop " + kRecordings + "mirror/probe.exr\nwait\nexpect error none\npicture " + path("drawn.png") + "\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_NE(read_text(path("footage.png")), read_text(path("drawn.png")));
}

TEST_F(TuneFaults, SaysSoWhereAFileIsDroppedThatIsNoneOfOurs) {
  const CommandResult result =
      run("set probe.yaw_deg 7\ndrop " + files_.write("notes.docx", "text") +
          "\nexpect message notes.docx: not a recording, scene (.toml), video, probe (.exr, .hdr) or model (.glb, .gltf, .obj, "
          ".ply)\nexpect probe.yaw_deg 7\nexpect error none\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST_F(TuneFaults, AsksBeforeADroppedRecordingTakesThePlaceOfChanges) {
  const std::string gloss = "drop " + kRecordings + "gloss\nexpect frame 0\nexpect frame 0\n";
  const CommandResult result =
      run("set probe.yaw_deg 7\n" + gloss + "click stay\nexpect probe.yaw_deg 7\n" + gloss +
          "click open without saving\nexpect object.mesh object.glb\nexpect probe.yaw_deg 0\nclick open\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST_F(TuneFaults, KeepsTheOldFileWhereTheDiskIsFull) {
  const std::string before = read_text(path("scene.toml"));
  // No file may grow: as on a full disk, writing fails.
  std::vector<std::string> words{"-c", "trap '' XFSZ; ulimit -f 0; exec \"$0\" \"$@\"", CATCHLIGHT_EXECUTABLE};
  for (const std::string& word : arguments("set probe.yaw_deg 7\nsave\nexpect message " + path("scene.toml") +
                                           ": cannot be written; is the disk full?\nexpect probe.yaw_deg 7\nquit\n"))
    words.push_back(word);
  const CommandResult result = run_program("/bin/sh", words, {});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(read_text(path("scene.toml")), before);
  for (const std::string& name : names_below(folder())) EXPECT_THAT(name, Not(HasSubstr("partial")));
}

TEST_F(TuneFaults, SaysWhereItCannotSave) {
  const CommandResult result = run(
      "set probe.yaw_deg 7\nsave /nowhere/scene.toml\nexpect message /nowhere/scene.toml: the scene's paths start from its own " +
      ("folder; expected a file in " + std::filesystem::canonical(folder()).string()) + "\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST(TuneWithoutOpenGl, SaysWhatToInstall) {
  const TemporaryFolder no_drivers;
  const CommandResult result = run_catchlight({"tune", "--frames", "1"}, {{"__EGL_VENDOR_LIBRARY_DIRS", no_drivers.path()}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("install Mesa (libegl1, libgl1-mesa-dri)"));
  EXPECT_EQ(count_of("\n  ", result.error), 1) << "then what was tried, a line each\n" << result.error;
}

}  // namespace
}  // namespace catchlight::tests
