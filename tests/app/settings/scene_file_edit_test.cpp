#include "app/settings/scene_file_edit.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "app/settings/parameters.hpp"
#include "catchlight/error.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::message_of;
using tests::read_scene;
using tests::TemporaryFolder;

/// The text after keys were set to texts, as options give them.
std::string edited(const std::string& text, const std::vector<std::pair<std::string, std::string>>& changes) {
  const SceneSettings before = read_scene(text);
  SceneSettings after = before;
  for (const auto& [key, value] : changes)
    if (const Parameter* parameter = find_parameter(key); parameter && std::holds_alternative<PathKind>(parameter->kind))
      set_parameter(after, *parameter, value);  // relative to the scene file, as in it
    else
      set_parameter_from_text(after, key, value);
  const std::string result = edited_scene_text(text, "scene.toml", before, after);
  const SceneSettings again = read_scene(result);
  for (const Parameter& parameter : parameters())
    for (std::size_t i = 0; i < element_count(after, parameter); ++i)
      EXPECT_EQ(parameter_text(again, parameter, i), parameter_text(after, parameter, i)) << parameter.key << "\n" << result;
  EXPECT_EQ(again.by_hand, after.by_hand) << result;
  return result;
}

constexpr const char* kScene = R"(# A ring in the sun.
look = "camera"   # as the camera sees it

[tag]
family = "tag36h11"
id = 101          # the one on the table
size_m = 0.08

[[object]]
mesh = "ring.glb" # größer als der Würfel
tag_from_object = { rotation_deg = [90, 0, 0] }

[glare]
bloom_strength = 0.5
)";

TEST(EditedSceneText, IsTheSameWhereNothingChanged) {
  EXPECT_EQ(edited(kScene, {}), kScene);
  EXPECT_EQ(edited("", {}), "");
}

TEST(EditedSceneText, ReplacesAValueInItsPlaceAndKeepsComments) {
  const std::string text = edited(kScene, {{"tag.id", "7"}});
  EXPECT_THAT(text, HasSubstr("id = 7          # the one on the table\n"));
  EXPECT_THAT(text, StartsWith("# A ring in the sun.\nlook = \"camera\"   # as the camera sees it\n"));
}

TEST(EditedSceneText, CountsColumnsInCharacters) {
  EXPECT_THAT(edited("[[object]] # größer\nmesh = \"größe.glb\" # groß\n", {{"object.mesh", "würfel.glb"}}),
              HasSubstr("mesh = \"würfel.glb\" # groß\n"));
}

TEST(EditedSceneText, PutsANewKeyAtTheEndOfItsSection) {
  EXPECT_THAT(edited(kScene, {{"tag.white_albedo", "0.7"}}), HasSubstr("size_m = 0.08\nwhite_albedo = 0.7\n\n[[object]]"));
  EXPECT_THAT(edited(kScene, {{"object.tag_from_object.scale", "2"}}),
              HasSubstr("tag_from_object = { rotation_deg = [90, 0, 0], scale = 2 }"));
}

TEST(EditedSceneText, MakesASectionThatIsNotThere) {
  EXPECT_THAT(edited(kScene, {{"probe.yaw_deg", "30"}}), HasSubstr("bloom_strength = 0.5\n\n[probe]\nyaw_deg = 30\n"));
  EXPECT_EQ(edited("", {{"exposure.ev", "-1"}}), "[exposure]\nev = -1\n");
  EXPECT_EQ(edited("[tag]\nid = 3\n", {{"look", "classic"}}).substr(0, 16), "look = \"classic\"");
}

TEST(EditedSceneText, WritesEachKindAsTomlDoes) {
  EXPECT_THAT(edited(kScene, {{"lens.noise", "false"}}), HasSubstr("[lens]\nnoise = false\n"));
  EXPECT_THAT(edited(kScene, {{"lens.noise", "auto"}}), HasSubstr("noise = \"auto\"\n"));
  EXPECT_THAT(edited(kScene, {{"receiver.albedo", "0.5,0.6,0.7"}}), HasSubstr("albedo = [0.5, 0.6, 0.7]\n"));
  EXPECT_THAT(edited(kScene, {{"probe.image", "a \"b\".exr"}}), HasSubstr("[probe]\nimage = "));
}

TEST(EditedSceneText, TakesOutWhatIsLeftToTheProgram) {
  const SceneSettings before = read_scene(kScene);
  SceneSettings after = before;
  set_parameter_from_text(after, "glare.bloom_strength",
                          parameter_text(SceneSettings(), *find_parameter("glare.bloom_strength")));
  after.by_hand.erase("glare.bloom_strength");
  const std::string text = edited_scene_text(kScene, "scene.toml", before, after);
  EXPECT_EQ(text.find("strength"), std::string::npos);
  EXPECT_THAT(text, HasSubstr("[glare]\n"));
}

TEST(EditedSceneText, TakesTheRightOneOfSeveralObjects) {
  const std::string two = "[[object]]\nmesh = \"a.glb\"\n\n[[object]]\nmesh = \"b.glb\"\n";
  EXPECT_EQ(edited(two, {{"object[1].tag_from_object.scale", "2"}}), two + "tag_from_object = { scale = 2 }\n");
}

TEST(EditedSceneText, NamesFilesFromTheScenesFolder) {
  SceneSettings before;
  before.folder = "/shots/one";
  SceneSettings after = before;
  set_parameter(after, *find_parameter("probe.image"), std::string("/shots/one/light/sky.exr"));
  EXPECT_EQ(edited_scene_text("", "s.toml", before, after), "[probe]\nimage = \"light/sky.exr\"\n");
  set_parameter(after, *find_parameter("probe.image"), std::string("/shots/two/sky.exr"));
  EXPECT_EQ(edited_scene_text("", "s.toml", before, after), "[probe]\nimage = \"/shots/two/sky.exr\"\n");
}

TEST(EditedSceneText, OfAnyChangeIsReadBackAsThatChange) {
  std::mt19937 random(5);
  for (int round = 0; round < 60; ++round) {
    std::vector<std::pair<std::string, std::string>> changes;
    for (int i = 0; i < 6; ++i) {
      const Parameter& parameter = parameters()[random() % parameters().size()];
      if (parameter.key.starts_with("tag.bundle") || parameter.key == "tag.family") continue;
      if (const auto* real = std::get_if<RealKind>(&parameter.kind))
        changes.emplace_back(parameter.key, std::to_string(real->min + (real->max - real->min) * 0.001 * (random() % 1000)));
      else if (const auto* integer = std::get_if<IntegerKind>(&parameter.kind))
        changes.emplace_back(parameter.key, std::to_string(integer->min + static_cast<int>(random() % 2)));
      else if (std::holds_alternative<SwitchKind>(parameter.kind))
        changes.emplace_back(parameter.key, random() % 2 ? "true" : "auto");
    }
    edited(kScene, changes);
  }
}

TEST(EditedSceneText, RefusesWhatIsNoToml) {
  EXPECT_THAT(message_of<Error>([] { edited_scene_text("[tag\n", "s.toml", {}, {}); }), StartsWith("s.toml:1:"));
}

TEST(SaveSceneFile, LeavesTheOldFileWhereItCannotWrite) {
  const TemporaryFolder folder;
  const std::string path = folder.write("scene.toml", kScene);
  SceneSettings after = read_scene(kScene);
  set_parameter_from_text(after, "tag.id", "9");
  const auto refusal = [&](const std::string& to) {
    return message_of<Error>([&] { save_scene_file(path, to, read_scene(kScene), after); });
  };
  EXPECT_THAT(refusal(folder.path("none/scene.toml")), HasSubstr("none/scene.toml"));
  std::filesystem::permissions(path, std::filesystem::perms::owner_read);
  EXPECT_THAT(refusal(path), HasSubstr("scene.toml: is write-protected"));
  std::filesystem::permissions(path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  save_scene_file(path, path, read_scene(kScene), after);
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("id = 9          # the one"));
}

}  // namespace
}  // namespace catchlight::app
