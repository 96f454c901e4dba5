#include "app/window/start/dropped_file.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "tests/support/temporary_folder.hpp"

namespace catchlight::app {
namespace {

TEST(DroppedFile, IsKnownByWhatItIsAndByItsEnding) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(kind_of_dropped(folder.path()), DroppedKind::recording);
  EXPECT_EQ(kind_of_dropped("/a/sky.EXR"), DroppedKind::probe);
  EXPECT_EQ(kind_of_dropped("/a/ring.glb"), DroppedKind::model);
  EXPECT_EQ(kind_of_dropped("/a/take2.mov"), DroppedKind::footage);
  EXPECT_EQ(kind_of_dropped("/a/scene.toml"), DroppedKind::scene);
  EXPECT_EQ(kind_of_dropped("/a/notes.docx"), DroppedKind::other);
  EXPECT_EQ(kind_of_dropped("/a/README"), DroppedKind::other);
}

/// What the command line said of the recording that it opened is not true of another.
TEST(DroppedFile, OpensAnotherRecordingWithoutTheLastOnesSceneAndCamera) {
  RecordingOverrides given;
  given.scene_file = "one.toml", given.fov_deg = 50, given.renderer = Renderer::cpu;
  const OpenedRecording opened = opened_by_drop("/shots/two", given, {});
  EXPECT_EQ(opened.location, "/shots/two");
  EXPECT_FALSE(opened.overrides.scene_file || opened.overrides.fov_deg);
  EXPECT_EQ(opened.overrides.renderer, Renderer::cpu);
}

TEST(DroppedFile, OpensTheRecordingOfADroppedScene) {
  EXPECT_EQ(opened_by_drop("/shots/two/scene.toml", {}, {}).location, "/shots/two");
  EXPECT_FALSE(opened_by_drop("/shots/two/scene.toml", {}, {}).overrides.scene_file);
  EXPECT_EQ(opened_by_drop("/shots/two/night.toml", {}, {}).overrides.scene_file, "/shots/two/night.toml");
}

TEST(DroppedFile, GivesFootageTheSceneAndTheCameraThatAreOpen) {
  std::optional<Recording> now(std::in_place);
  now->scene_file.emplace("/shots/one/scene.toml");
  now->camera_file.emplace("/shots/one/camera.yaml");
  const OpenedRecording opened = opened_by_drop("/shots/take2.mov", {}, now);
  EXPECT_EQ(opened.location, "/shots/take2.mov");
  EXPECT_EQ(opened.overrides.scene_file.value_or(""), "/shots/one/scene.toml");
  EXPECT_EQ(opened.overrides.camera_file.value_or(""), "/shots/one/camera.yaml");
}

}  // namespace
}  // namespace catchlight::app
