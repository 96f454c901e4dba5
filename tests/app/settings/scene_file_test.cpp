#include "app/settings/scene_file.hpp"
#include "app/settings/parameters.hpp"
#include "catchlight/error.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using tests::message_of;
using tests::read_scene;
using tests::scene_refusal;
using tests::TemporaryFolder;

TEST(SceneFile, EmptyFileHasTheDefaults) {
  const SceneSettings read_settings = read_scene(""), defaults;
  for (const Parameter& parameter : parameters())
    EXPECT_EQ(parameter_text(read_settings, parameter), parameter_text(defaults, parameter)) << parameter.key;
  EXPECT_TRUE(read_settings.by_hand.empty());
  EXPECT_TRUE(read_settings.objects.empty());
}

TEST(SceneFile, ReadsEveryKind) {
  const SceneSettings scene = read_scene(R"(
[tag]
family = "tag25h9"
id = 12
size_m = 0.14

[[object]]
mesh = "object.glb"
tag_from_object = { translation_m = [0, 0.5, 1], rotation_deg = [90, 0, 0], scale = 2 }
shading = "prt"

[receiver]
plane = "none"
albedo = [0.1, 0.2, 0.3]

[glare]
enabled = false
streak_directions = 6

[lens]
noise = false
distortion = true
motion_blur = "auto"
)");
  EXPECT_EQ(scene.tag.family, "tag25h9");
  EXPECT_EQ(scene.tag.id, 12);
  EXPECT_EQ(scene.tag.size_m, 0.14);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].mesh, "object.glb");
  EXPECT_EQ(scene.objects[0].translation_m, glm::dvec3(0, 0.5, 1));
  EXPECT_EQ(scene.objects[0].scale, 2);
  EXPECT_EQ(scene.receiver.plane, ReceiverPlane::none);
  EXPECT_EQ(scene.receiver.albedo, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_FALSE(scene.glare.enabled);
  EXPECT_EQ(scene.glare.streak_directions, 6);
  EXPECT_EQ(scene.lens.noise, Switch::off);
  EXPECT_EQ(scene.lens.distortion, Switch::on);
  EXPECT_EQ(scene.lens.motion_blur, Switch::automatic);
  EXPECT_TRUE(scene.is_by_hand("glare.enabled"));
  EXPECT_FALSE(scene.is_by_hand("glare.threshold"));
}

TEST(SceneFile, FilesAreRelativeToIt) {
  const TemporaryFolder folder;
  const SceneSettings scene = read_scene_file(folder.write("scene.toml", "[probe]\nimage = \"light/probe.exr\"\n"));
  EXPECT_EQ(scene.resolve(scene.probe.image), folder.path("light/probe.exr"));
  EXPECT_EQ(scene.resolve("/elsewhere/probe.exr"), "/elsewhere/probe.exr");
}

TEST(SceneFile, SeveralObjectsStayApart) {
  const SceneSettings scene = read_scene("[[object]]\nmesh = 'a.glb'\ntag_from_object.scale = 3\n[[object]]\nmesh = 'b.glb'\n");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].mesh, "a.glb");
  EXPECT_EQ(scene.objects[0].scale, 3);
  EXPECT_EQ(scene.objects[1].mesh, "b.glb");
  EXPECT_EQ(scene.objects[1].scale, 1);
}

constexpr double kRounding = 1e-14;  // a few products of sines and cosines in double

void expect_maps(const SceneSettings::Object& object, const glm::dvec3& point_object, const glm::dvec3& point_tag) {
  const glm::dvec3 mapped = object.tag_from_object() * glm::dvec4(point_object, 1);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mapped[i], point_tag[i], kRounding) << "component " << i;
}

TEST(ObjectPlacement, NinetyDegreesAboutXStandsGltfUpOnTheTag) {
  SceneSettings::Object object;
  object.rotation_deg = {90, 0, 0};
  expect_maps(object, {0, 1, 0}, {0, 0, 1});
  expect_maps(object, {0, 0, 1}, {0, -1, 0});
  expect_maps(object, {1, 0, 0}, {1, 0, 0});
}

/// x first, then y, then z, each about the tag's own axis: +y goes to +z, then to +x, then to +y. Any other order ends elsewhere.
TEST(ObjectPlacement, TurnsAboutXThenYThenZ) {
  SceneSettings::Object object;
  object.rotation_deg = {90, 90, 90};
  expect_maps(object, {0, 1, 0}, {0, 1, 0});
  expect_maps(object, {1, 0, 0}, {0, 0, -1});
  expect_maps(object, {0, 0, 1}, {1, 0, 0});
}

TEST(ObjectPlacement, ScalesBeforeItTurnsAndMoves) {
  SceneSettings::Object object;
  object.translation_m = {10, 20, 30};
  object.rotation_deg = {0, 0, 90};
  object.scale = 2;
  expect_maps(object, {1, 0, 0}, {10, 22, 30});
}

TEST(ObjectPlacement, MatrixIsThreeRows) {
  const SceneSettings scene =
      read_scene("[[object]]\nmesh = 'a.glb'\ntag_from_object = { matrix = [[1,2,3,4],[5,6,7,8],[9,10,11,12]] }\n");
  expect_maps(scene.objects.at(0), {0, 0, 0}, {4, 8, 12});
  expect_maps(scene.objects.at(0), {1, 0, 0}, {5, 13, 21});
  expect_maps(scene.objects.at(0), {0, 0, 1}, {7, 15, 23});
}

/// The ground truth's `matte` scene gives the same placement both ways.
TEST(ObjectPlacement, AnglesAndMatrixAgree) {
  SceneSettings::Object object;
  object.rotation_deg = {90, 0, 12};
  expect_maps(object, {1, 0, 0}, {0.97814760073380564, 0.20791169081775934, 0});
  expect_maps(object, {0, 1, 0}, {0, 0, 1});
  expect_maps(object, {0, 0, 1}, {0.20791169081775934, -0.97814760073380564, 0});
}

struct Mistake {
  const char *name, *text, *message;
};

class RefusedScene : public ::testing::TestWithParam<Mistake> {};

TEST_P(RefusedScene, SaysWhereAndWhatToDo) {
  EXPECT_EQ(scene_refusal(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    SceneFile, RefusedScene,
    ::testing::Values(
        Mistake{"UnknownKey", "[glare]\nenabld = true\n", "2:1: unknown key 'glare.enabld'; did you mean 'glare.enabled'?"},
        Mistake{"UnknownTable", "[glaer]\nenabled = true\n", "1:2: unknown key 'glaer'; did you mean 'glare'?"},
        Mistake{"KeyOutsideItsTable", "yaw_deg = 3\n", "1:1: unknown key 'yaw_deg'; did you mean 'probe.yaw_deg'?"},
        Mistake{"UnknownObjectKey", "[[object]]\nmesh = 'a.glb'\ntag_from_object = { translate_m = [0, 0, 0] }\n",
                "3:21: unknown key 'object.tag_from_object.translate_m'; did you mean 'object.tag_from_object.translation_m'?"},
        Mistake{"WrongType", "[tag]\nid = \"seven\"\n", "2:6: tag.id is \"seven\"; expected a whole number from 0 to 1000000"},
        Mistake{"RealForInteger", "[quality]\nbands = 6.0\n", "2:9: quality.bands is 6; expected a whole number from 1 to 10"},
        Mistake{"TableForNumber", "[tag]\nsize_m = { m = 1 }\n",
                "2:10: tag.size_m is a table; expected a number from 0.001 to 100 m"},
        Mistake{"DateForText", "[probe]\nimage = 2020-01-01\n",
                "2:9: probe.image is a date; expected \"overcast\", \"studio\", \"sky\", "
                "\"sky:sun_elevation_deg=35,turbidity=3\", or the name of a file"},
        Mistake{"ValueForTable", "glare = true\n", "1:9: 'glare' is a boolean; expected a table"},
        Mistake{"OutOfRange", "[tag]\nsize_m = -0.1\n", "2:10: tag.size_m is -0.1; expected a number from 0.001 to 100 m"},
        Mistake{"NotANumber", "[probe]\nev = nan\n", "2:6: probe.ev is nan; expected a number from -30 to 30 EV"},
        Mistake{"ShortVector", "[receiver]\nalbedo = [0.8, 0.8]\n",
                "2:10: receiver.albedo is an array; expected three numbers from 0 to 1"},
        Mistake{"TextInVector", "[receiver]\nalbedo = [0.8, 'x', 0.8]\n",
                "2:10: receiver.albedo is an array; expected three numbers from 0 to 1"},
        Mistake{"UnknownExposure", "[exposure]\nmode = \"eye\"\n",
                "2:8: exposure.mode is \"eye\"; expected \"match\", \"fixed\" or \"auto\""},
        Mistake{"OtherShading", "[[object]]\nmesh = 'a.glb'\nshading = \"toon\"\n",
                "3:11: object.shading is \"toon\"; expected \"prt\""},
        Mistake{"LensNoise", "[lens]\nnoise = 3\n", "2:9: lens.noise is 3; expected \"auto\", true or false"},
        Mistake{"BoardTagWithoutId", "[[tag.bundle]]\nsize_m = 0.1\n", "1:1: this [[tag.bundle]] has no id; give `id = NUMBER`"},
        Mistake{"BoardInSingleBrackets", "[tag.bundle]\nid = 3\n",
                "1:1: expected [[tag.bundle]], in double brackets, once for each further tag of the board"},
        Mistake{"ObjectInSingleBrackets", "[object]\nmesh = 'a.glb'\n",
                "1:1: expected [[object]], in double brackets, once for each object"},
        Mistake{"ObjectWithoutMesh", "[tag]\nid = 1\n[[object]]\nshading = 'prt'\n",
                "3:1: this [[object]] has no mesh; give `mesh = \"FILE\"`"},
        Mistake{"MatrixOfFourRows",
                "[[object]]\nmesh = 'a.glb'\ntag_from_object = { matrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]] }\n",
                "3:21: object.tag_from_object.matrix: expected 3 rows of 4 finite numbers"},
        Mistake{"MatrixWithInfinity",
                "[[object]]\nmesh = 'a.glb'\ntag_from_object = { matrix = [[inf,0,0,0],[0,1,0,0],[0,0,1,0]] }\n",
                "3:21: object.tag_from_object.matrix: expected 3 rows of 4 finite numbers"},
        Mistake{"MatrixAndScale",
                "[[object]]\nmesh = 'a.glb'\ntag_from_object = { scale = 2, matrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0]] }\n",
                "3:1: 'object.tag_from_object' has a matrix and more; expected either the matrix alone or translation_m, "
                "rotation_deg and "
                "scale"}),
    [](const auto& test) { return test.param.name; });

TEST(SceneFile, BrokenTomlNamesTheLine) {
  EXPECT_THAT(scene_refusal("[tag]\nid = = 3\n"), StartsWith("2:6: "));
}

/// What people write who do not write TOML every day: each is told in plain words what was expected.
TEST(SceneFile, BrokenTomlIsExplainedInPlainWords) {
  for (const auto& [text, expected] : std::initializer_list<std::pair<std::string, std::string>>{
           {"hello world\n", "1:7: expected key = value, found 'w'"},
           {"[tag\nid = 3\n", "1:5: expected ], as in [tag] or [[object]], found the end of the line"},
           {"[tag]\nid =\n", "2:5: expected a value, found the end of the line"},
           {"[tag]\nid = 3\nid = 4\n", "3:6: the key 'id' is there already; leave one of the two out"},
           {"[tag]\nid = 3\n[tag]\n", "3:1: the table 'tag' is there already; put all of its keys under its first heading"},
           {"[[object]]\nmesh = robot.glb\n", "2:8: expected a value: a number, true, false, or text in quotes"},
           {"[[object]]\nmesh = \"C:\\shots\\a.glb\"\n", "write file names with / or in single quotes"},
           {"[[object]]\nmesh = \"a.glb\n", "2:14: the closing quote is missing on this line"},
           {"[tag]\nsize_m = 0,08\n", "2:11: expected the end of the line, found ','; decimals are written with a point: 0.08"},
           {"[tag]\nsize_m = .08\n", "2:10: a number begins with a digit: 0.08"},
           {"[tag]\nsize_m: 0.08\n", "2:7: expected key = value, found ':'"},
           {"\xff\xfe[", "1:1: is not UTF-8 text; save it as UTF-8"},
           {std::string(8, '\0'), "1:1: expected TOML, found what is no text"}}) {
    const std::string refusal = scene_refusal(text);
    EXPECT_THAT(refusal, HasSubstr(expected)) << text;
    EXPECT_THAT(refusal, Not(HasSubstr("while parsing"))) << "the library's words";
  }
}

TEST(SceneFile, RepeatedKeyNamesTheLine) {
  EXPECT_THAT(scene_refusal("[tag]\nid = 3\nid = 4\n"), StartsWith("3:"));
}

TEST(SceneFile, MissingFile) {
  const TemporaryFolder folder;
  const std::string path = folder.path("none.toml");
  EXPECT_EQ(message_of<Error>([&] { read_scene_file(path); }),
            path + ": cannot open the scene file; does it exist, and may it be read?");
}

TEST(SceneFile, FolderInsteadOfFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<Error>([&] { read_scene_file(folder.path()); }), HasSubstr("is a folder"));
}

}  // namespace
}  // namespace catchlight::app
