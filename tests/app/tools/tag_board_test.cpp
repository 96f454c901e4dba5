// [[tag.bundle]] and [tag] of a scene file, as the tracker is told of them.
#include <gmock/gmock.h>

#include "app/settings/scene_file.hpp"
#include "catchlight/tag.hpp"
#include "tests/support/scene_text.hpp"

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using tests::read_scene;
using tests::scene_refusal;

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12) << i;
}

TEST(TagBoard, ATagAloneIsTheWholeTarget) {
  const TagTarget target = read_scene("[tag]\nfamily = \"tag25h9\"\nid = 12\nsize_m = 0.14\n").tag.target();
  EXPECT_TRUE(target.bundle.empty());
  EXPECT_EQ(static_cast<const PrintedTag&>(target), (PrintedTag{"tag25h9", 12, 0.14}));
  ASSERT_EQ(target.tags().size(), 1u);
  EXPECT_EQ(target.tags()[0].tag_from_this.translation_m, glm::dvec3(0));
}

TEST(TagBoard, WhatAFurtherTagDoesNotSayIsAsTheFirst) {
  const TagTarget target = read_scene(R"(
[tag]
family = "tag25h9"
size_m = 0.14
[[tag.bundle]]
id = 1
[[tag.bundle]]
id = 2
family = "tag16h5"
size_m = 0.05
)")
                               .tag.target();
  ASSERT_EQ(target.bundle.size(), 2u);
  EXPECT_EQ(static_cast<const PrintedTag&>(target.bundle[0]), (PrintedTag{"tag25h9", 1, 0.14}));
  EXPECT_EQ(static_cast<const PrintedTag&>(target.bundle[1]), (PrintedTag{"tag16h5", 2, 0.05}));
  EXPECT_EQ(target.bundle[0].tag_from_this.translation_m, glm::dvec3(0));
  EXPECT_EQ(target.bundle[0].tag_from_this.rotation, glm::dmat3(1.0));
  EXPECT_EQ(target.tags().size(), 3u);
}

TEST(TagBoard, DefaultsComeFromATagThatIsWrittenAfterTheBundle) {
  const SceneSettings scene = read_scene("[[tag.bundle]]\nid = 1\n[tag]\nfamily = \"tag25h9\"\nsize_m = 0.14\n");
  EXPECT_EQ(scene.tag.target().bundle.at(0).family, "tag25h9");
  EXPECT_EQ(scene.tag.target().bundle.at(0).size_m, 0.14);
}

TEST(TagBoard, AFurtherTagsPointsAreGivenInTheFirstTagsFrame) {
  // A quarter turn about z: its own x points along the first tag's y.
  const auto tag_from_this = read_scene(R"(
[[tag.bundle]]
id = 1
tag_from_this = { translation_m = [0.1, 0.02, -0.03], rotation_deg = [0, 0, 90] }
)")
                                 .tag.target()
                                 .bundle.at(0)
                                 .tag_from_this;
  expect_near(tag_from_this * glm::dvec3(0), {0.1, 0.02, -0.03});
  expect_near(tag_from_this * glm::dvec3(0.01, 0, 0), {0.1, 0.03, -0.03});
}

TEST(TagBoard, TurnsAreMadeAboutXThenYThenZ) {
  const auto turned = [](const char* rotation_deg) {
    const std::string text = "[[tag.bundle]]\nid = 1\ntag_from_this = { rotation_deg = " + std::string(rotation_deg) + " }\n";
    return read_scene(text).tag.target().bundle.at(0).tag_from_this.rotation;
  };
  // About x by 90° y becomes z; then about y by 90° that z becomes x; then about z by 90° that x becomes y.
  expect_near(turned("[90, 0, 0]") * glm::dvec3(0, 1, 0), {0, 0, 1});
  expect_near(turned("[90, 90, 0]") * glm::dvec3(0, 1, 0), {1, 0, 0});
  expect_near(turned("[90, 90, 90]") * glm::dvec3(0, 1, 0), {0, 1, 0});
  expect_near(turned("[90, 90, 90]") * glm::dvec3(1, 0, 0), {0, 0, -1});
}

TEST(TagBoard, MistakesAreNamed) {
  EXPECT_THAT(scene_refusal("[[tag.bundle]]\nsize_m = 0.1\n"), HasSubstr("no id"));
  EXPECT_THAT(scene_refusal("[tag.bundle]\nid = 1\n"), HasSubstr("[[tag.bundle]]"));
  EXPECT_THAT(scene_refusal("[[tag.bundle]]\nid = 1\nsize = 0.1\n"), HasSubstr("tag.bundle.size_m"));
  EXPECT_THAT(scene_refusal("[[tag.bundle]]\nid = 1\nfamily = \"tag99\"\n"), HasSubstr("tag36h11"));
  EXPECT_THAT(scene_refusal("[[tag.bundle]]\nid = -1\n"), HasSubstr("tag.bundle.id"));
}

TEST(TagRefinement, EachChoiceReachesTheTracker) {
  const auto chosen = [](const std::string& name) {
    return read_scene("[tag]\nrefinement = \"" + name + "\"\n").tag.tracker_options().refinement;
  };
  EXPECT_EQ(chosen("none"), tracking::Refinement::none);
  EXPECT_EQ(chosen("corners"), tracking::Refinement::corners);
  EXPECT_EQ(chosen("direct"), tracking::Refinement::direct);
  EXPECT_EQ(read_scene("").tag.tracker_options().refinement, tracking::Refinement::direct) << "unless said";
  const std::string message = scene_refusal("[tag]\nrefinement = \"best\"\n");
  for (const char* part : {"best", "none", "corners", "direct"}) EXPECT_THAT(message, HasSubstr(part));
}

}  // namespace
}  // namespace catchlight::app
