// The player beside the window: what it does when files change under it.
#include "app/window/playing/shot_player.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "app/settings/parameters.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using tests::TemporaryFolder;

const std::string kRecordings = CATCHLIGHT_SOURCE_DIR "/recordings/";

/// A recording of its own, drawn coarsely, whose files may be spoilt.
class ShotPlayerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    cache_ = std::make_unique<TemporaryFolder>();
    setenv("XDG_CACHE_HOME", cache_->path().c_str(), 1);
  }
  static void TearDownTestSuite() { cache_.reset(); }

  ShotPlayerTest() {
    for (const char* name : {"video.mp4", "camera.yaml", "scene.toml", "object.glb", "probe.exr"})
      std::filesystem::copy_file(kRecordings + "matte/" + name, folder_.path(name));
  }

  void replace_probe() {
    std::filesystem::copy_file(kRecordings + "mirror/probe.exr", folder_.path("probe.exr"),
                               std::filesystem::copy_options::overwrite_existing);
  }

  Recording recording(RecordingOverrides overrides = {}) {
    overrides.parameters = {{"quality.bands", "3"},         {"quality.rays", "32"},           {"quality.bounces", "0"},
                            {"quality.light_samples", "8"}, {"quality.reflection_rays", "0"}, {"quality.receiver_points", "12"},
                            {"quality.samples", "1"}};
    return open_recording(folder_.path(), overrides);
  }

  /// Asks for the first frame, and looks every few milliseconds until it is as it should be: the test's time limit ends the rest.
  static std::shared_ptr<const DrawnFrame> first_frame(ShotPlayer& player, const Recording& recording) {
    player.ask({.settings = recording.scene});
    until([&] { return player.is_idle(); });
    return player.newest();
  }
  template <class IsSo>
  static void until(const IsSo& is_so) {
    while (!is_so()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  static bool has_error(const ShotPlayer& player) { return player.is_idle() && player.status().error; }

  static inline std::unique_ptr<TemporaryFolder> cache_;
  TemporaryFolder folder_;
};

TEST_F(ShotPlayerTest, DrawsAProbeThatWasSavedAnew) {
  ShotPlayer player(recording());
  const auto before = first_frame(player, recording());
  replace_probe();
  until([&] { return player.newest() != before && player.is_idle(); });
  EXPECT_EQ(player.status().error, std::nullopt);
  EXPECT_NE(player.newest()->composite.rgb, before->composite.rgb);
  ShotPlayer afresh(recording());
  EXPECT_EQ(player.newest()->composite.rgb, first_frame(afresh, recording())->composite.rgb);
}

TEST_F(ShotPlayerTest, ShowsTheFootageWhereTheProbeIsMissingUntilItComes) {
  std::filesystem::remove(folder_.path("probe.exr"));
  ShotPlayer player(recording());
  player.ask({.settings = recording().scene, .position = 3});
  until([&] { return player.is_idle(); });
  EXPECT_THAT(player.status().error.value_or(""), HasSubstr("probe.exr"));
  EXPECT_EQ(player.newest()->position, 3);
  EXPECT_EQ(player.newest()->composite.rgb, player.newest()->plate.rgb);
  replace_probe();
  until([&] { return !has_error(player) && player.is_idle(); });
  EXPECT_NE(player.newest()->composite.rgb, player.newest()->plate.rgb);
}

TEST_F(ShotPlayerTest, KeepsThePictureWhereAProbeBecomesUnreadable) {
  ShotPlayer player(recording());
  const auto before = first_frame(player, recording());
  folder_.write("probe.exr", "no picture");
  until([&] { return has_error(player); });
  EXPECT_THAT(*player.status().error, HasSubstr("probe.exr"));
  EXPECT_EQ(player.newest(), before);
}

TEST_F(ShotPlayerTest, OpensTheShotAgainWithACameraThatWasSavedAnew) {
  ShotPlayer player(recording());
  const auto before = first_frame(player, recording());
  folder_.write("camera.yaml", "no camera");
  until([&] { return has_error(player); });
  EXPECT_THAT(*player.status().error, HasSubstr("camera.yaml"));
  std::filesystem::copy_file(kRecordings + "matte/camera.yaml", folder_.path("camera.yaml"),
                             std::filesystem::copy_options::overwrite_existing);
  until([&] { return !has_error(player) && player.is_idle(); });
  EXPECT_EQ(player.newest()->composite.rgb, before->composite.rgb);
}

TEST_F(ShotPlayerTest, BakesRoughlyWhileAHandTurnsAndFullyWhenItRests) {
  Recording turned = recording();
  ShotPlayer player(turned);
  const auto still = first_frame(player, turned);
  const auto ask = [&](double yaw_deg, bool moves) {
    set_parameter_from_text(turned.scene, "probe.yaw_deg", std::to_string(yaw_deg));
    player.ask({.settings = turned.scene, .moves = moves});
    until([&] { return player.is_idle(); });
    return player.newest();
  };
  EXPECT_EQ(still->rung, Rung::full);
  EXPECT_EQ(ask(20, true)->rung, Rung::rough);
  EXPECT_EQ(ask(0, true)->rung, Rung::rough) << "still under the hand";
  const auto rested = ask(0, false);
  EXPECT_EQ(rested->rung, Rung::full);
  EXPECT_EQ(rested->composite.rgb, still->composite.rgb);
}

TEST_F(ShotPlayerTest, SlidesAnObjectAtFullQuality) {
  Recording slid = recording();
  ShotPlayer player(slid);
  first_frame(player, slid);
  slid.scene.objects[0].translation_m.x += 0.01;
  player.ask({.settings = slid.scene, .moves = true});
  until([&] { return player.is_idle(); });
  EXPECT_EQ(player.newest()->rung, Rung::full) << "its bake comes along";
}

/// With OpenGL, whose shaders these are.
TEST_F(ShotPlayerTest, ReloadsShadersAndKeepsTheLastGoodOnes) {
  std::filesystem::copy(CATCHLIGHT_SOURCE_DIR "/shaders", folder_.path("shaders"));
  const std::string file = folder_.path("shaders/composite.frag"), good = tests::read_text(file);
  RecordingOverrides overrides;
  overrides.shader_folder = folder_.path("shaders");
  const Recording with_shaders = recording(overrides);
  ShotPlayer player(with_shaders);
  const auto before = first_frame(player, with_shaders);
  ASSERT_EQ(player.status().error, std::nullopt);

  folder_.write("shaders/composite.frag", good + "\nthis is no GLSL\n");
  until([&] { return has_error(player); });
  const auto line = std::to_string(std::ranges::count(good, '\n') + 2);
  EXPECT_THAT(*player.status().error, HasSubstr("composite.frag:" + line));
  EXPECT_EQ(player.newest()->composite.rgb, before->composite.rgb) << "the last good one draws";

  SceneSettings other = with_shaders.scene;
  set_parameter_from_text(other, "probe.yaw_deg", "30");
  const std::uint64_t turned = player.ask({.settings = other});
  until([&] { return player.newest()->wish == turned && player.is_idle(); });
  EXPECT_TRUE(player.status().error) << "the message stays while the shader is broken";

  folder_.write("shaders/composite.frag", good);
  player.ask({.settings = with_shaders.scene});
  until([&] { return player.is_idle() && !player.status().error; });
  EXPECT_EQ(player.newest()->composite.rgb, before->composite.rgb);
}

}  // namespace
}  // namespace catchlight::app
