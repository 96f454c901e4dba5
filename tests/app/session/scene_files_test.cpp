// A scene's objects as one mesh in the tag's frame.
#include "app/session/scene_files.hpp"
#include "render/mesh/bounds.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace catchlight::app {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::message_of;

/// A cube of 40 mm around its origin, +z up.
constexpr const char* kCube =
    "v -0.02 -0.02 -0.02\nv 0.02 -0.02 -0.02\nv 0.02 0.02 -0.02\nv -0.02 0.02 -0.02\nv -0.02 -0.02 0.02\nv 0.02 -0.02 0.02\n"
    "v 0.02 0.02 0.02\nv -0.02 0.02 0.02\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

class SceneObjects : public testing::Test {
 protected:
  SceneObjects() {
    scene_.folder = folder_.path();
    folder_.write("cube.obj", kCube);
    scene_.objects.emplace_back().mesh = "cube.obj";
  }

  render::Mesh load() {
    return load_objects(scene_, [this](const std::string& warning) { warnings_.push_back(warning); });
  }

  tests::TemporaryFolder folder_;
  SceneSettings scene_;
  std::vector<std::string> warnings_;
};

double area_of(const render::Mesh& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](int k) { return glm::dvec3(mesh.vertices[mesh.indices[i + k]].position_m); };
    area += glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) / 2;
  }
  return area;
}

TEST_F(SceneObjects, WhatLiesBelowTheTagIsNotThere) {
  const render::Mesh mesh = load();
  EXPECT_EQ(render::bounds_of(mesh).min_m, glm::vec3(-0.02f, -0.02f, 0));
  EXPECT_EQ(render::bounds_of(mesh).max_m, glm::vec3(0.02f));
  EXPECT_NEAR(area_of(mesh), 0.04 * 0.04 + 4 * 0.04 * 0.02, 1e-9) << "the top, and half of each side";
  for (const render::Vertex& vertex : mesh.vertices) {
    EXPECT_GE(vertex.position_m.z, 0);
    EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-5);
  }
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("cube.obj"), HasSubstr("20 mm below the tag"), HasSubstr("translation_m"))));
}

TEST_F(SceneObjects, WithoutReceiverNothingHidesIt) {
  scene_.receiver.plane = ReceiverPlane::none;
  EXPECT_NEAR(area_of(load()), 6 * 0.04 * 0.04, 1e-9);
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(SceneObjects, WhatStandsOnTheTagIsLeftAlone) {
  for (const double height_m : {0.02, 0.02 - 1e-7, 0.1}) {
    scene_.objects[0].translation_m.z = height_m;
    EXPECT_NEAR(area_of(load()), 6 * 0.04 * 0.04, 1e-9) << "with its bottom";
  }
  scene_.objects[0].translation_m.z = 0.0198;
  EXPECT_NEAR(area_of(load()), 0.04 * 0.04 + 4 * 0.04 * 0.0398, 1e-9);
  EXPECT_THAT(warnings_, IsEmpty()) << "a fifth of a millimetre is no mistake";
}

TEST_F(SceneObjects, TheProbeIsAboveTheFootAtHalfTheHeight) {
  scene_.objects[0].translation_m = {0.3, -0.2, 0.03};
  EXPECT_EQ(scene_in_tag_m(scene_), glm::dvec3(0.3, -0.2, 0));
  EXPECT_LT(glm::distance(probe_in_scene_m(load()), glm::dvec3(0, 0, 0.025)), 1e-8);

  std::string beside = kCube;  // a model that stands beside its own origin
  for (std::size_t at = 0; (at = beside.find("v ", at)) != std::string::npos; at += 2)
    beside.replace(at, beside.find(' ', at + 2) - at, beside[at + 2] == '-' ? "v 0.98" : "v 1.02");
  folder_.write("cube.obj", beside);
  EXPECT_LT(glm::distance(probe_in_scene_m(load()), glm::dvec3(1, 0, 0.025)), 1e-6);
}

TEST_F(SceneObjects, WhatLiesBelowAsAWholeIsSaid) {
  scene_.objects[0].translation_m.z = -0.1;
  EXPECT_THAT(message_of<Error>([&] { load(); }), AllOf(HasSubstr("above the tag"), HasSubstr("translation_m")));
  warnings_.clear();
  scene_.objects.emplace_back().mesh = "cube.obj";
  scene_.objects[1].translation_m.z = 0.02;
  EXPECT_NEAR(area_of(load()), 6 * 0.04 * 0.04, 1e-9);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("all of it")));
}

TEST_F(SceneObjects, TestObjectsStandOnTheTagHoweverModelsAreTurned) {
  scene_.tag.size_m = 0.2;
  for (const glm::dvec3& turn : {glm::dvec3(0), glm::dvec3(90, 0, 0), glm::dvec3(-90, 0, 0)}) {
    scene_.objects[0].rotation_deg = turn;
    scene_.objects[0].mesh = "sphere";
    const render::Bounds ball = render::bounds_of(load());
    EXPECT_LT(glm::distance(ball.min_m, glm::vec3(-0.075f, -0.075f, 0)), 1e-6f);
    EXPECT_LT(glm::distance(ball.max_m, glm::vec3(0.075f, 0.075f, 0.15f)), 1e-6f);
    scene_.objects[0].mesh = "chrome-and-grey";
    const render::Bounds pair = render::bounds_of(load());
    EXPECT_LT(glm::distance(pair.min_m, glm::vec3(-0.13f, -0.06f, 0)), 1e-6f);
    EXPECT_LT(glm::distance(pair.max_m, glm::vec3(0.13f, 0.06f, 0.12f)), 1e-6f);
  }
  scene_.objects[0].translation_m = {0, 0, 0.05};
  scene_.objects[0].scale = 0.5;
  EXPECT_NEAR(render::bounds_of(load()).min_m.z, 0.05, 1e-6);
  EXPECT_NEAR(render::bounds_of(load()).max_m.z, 0.11, 1e-6);
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(SceneObjects, ChromeMirrorsAndGreyIsMatte) {
  scene_.objects[0].mesh = "chrome-and-grey";
  const render::Mesh pair = load();
  ASSERT_EQ(pair.materials.size(), 2u);
  for (std::size_t t = 0; t < pair.triangle_material.size(); ++t) {
    const render::Vertex& corner = pair.vertices[pair.indices[3 * t]];
    const bool is_chrome = pair.materials[pair.triangle_material[t]].metallic == 1;
    EXPECT_EQ(is_chrome, corner.position_m.x < 0);
    const glm::vec3 middle_m(is_chrome ? -0.028f : 0.028f, 0, 0.024f);
    EXPECT_GT(glm::dot(corner.normal, glm::normalize(corner.position_m - middle_m)), 0.9999f) << "outward";
  }
  EXPECT_EQ(pair.materials[1].base_color, glm::vec3(0.18f));
  EXPECT_EQ(pair.materials[1].dielectric_f0, 0);
}

}  // namespace
}  // namespace catchlight::app
