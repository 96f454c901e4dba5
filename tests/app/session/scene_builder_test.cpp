#include "app/session/scene_builder.hpp"
#include "app/settings/parameters.hpp"
#include "render/made_probe/made_probe.hpp"
#include "render/math/sh.hpp"
#include "tests/support/parameter_values.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace catchlight::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::message_of;
using tests::TemporaryFolder;

/// A 2 cm square facing up, a centimetre above the tag.
constexpr const char* kSquare =
    "v -0.01 -0.01 0.01\nv 0.01 -0.01 0.01\nv 0.01 0.01 0.01\nv -0.01 0.01 0.01\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n";

void ignore(const std::string&) {}

/// A scene with a square in a constant light of 0.5; its cache is its own.
class SceneBuild : public ::testing::Test {
 protected:
  SceneBuild() {
    setenv("XDG_CACHE_HOME", folder_.path("cache").c_str(), 1);
    scene_.folder = folder_.path();
    folder_.write("square.obj", kSquare);
    scene_.objects.emplace_back().mesh = "square.obj";
    write_probe([](const glm::dvec3&) { return glm::vec3(0.5f); });
    scene_.probe.image = "probe.exr";
    scene_.quality = {.tolerance = 0.004, .bands = 2, .rays = 16, .bounces = 0, .samples = 1, .receiver_points = 4};
    scene_.by_hand = {"quality.rays"};
  }

  /// `radiance` of a direction in the probe frame.
  template <class Radiance>
  void write_probe(Radiance radiance) {
    render::Probe probe{Image(64, 32), render::ProbeLayout::latlong};
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 64; ++x) {
        const glm::vec3 value = radiance(render::direction_from_texel(probe.layout, 64, 32, x, y).value());
        for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = value[c];
      }
    render::save_probe(folder_.path("probe.exr"), probe);
  }

  /// Other values for all parameters of these costs, but where that needs another probe's file.
  void change_all(const std::set<ChangeCost>& costs) {
    for (const Parameter& parameter : parameters())
      if (costs.contains(parameter.cost) && parameter.key != "probe.image" && parameter.key != "probe.layout")
        set_parameter_from_text(scene_, parameter.key, tests::other_value(parameter));
  }

  /// Builds the scene by a builder that has made nothing before.
  BuiltScene build() {
    return SceneBuilder().build(scene_, ignore, [](double) {});
  }

  TemporaryFolder folder_;
  SceneSettings scene_;
};

TEST_F(SceneBuild, ConstantLightOnTheTagIsItsRadiance) {
  EXPECT_NEAR(tag_irradiance_over_pi(build(), {}).g, 0.5, 0.005);  // a 64 x 32 probe's horizon is a texel thick
}

TEST_F(SceneBuild, MaterialLibraryOfAMeshIsPartOfIt) {
  folder_.write("square.mtl", "newmtl paint\nKd 0.2 0.4 0.6\n");
  folder_.write("square.obj", std::string("mtllib square.mtl\nusemtl paint\n") + kSquare);
  SceneBuilder builder;
  EXPECT_NEAR(builder.load(scene_, ignore).scene.mesh.materials.back().base_color.g, 0.4, 1e-6);
  builder.load(scene_, ignore);
  EXPECT_EQ(builder.times_made(ScenePart::mesh), 1);
  folder_.write("square.mtl", "newmtl paint\nKd 0.2 0.75 0.6\n");
  EXPECT_NEAR(builder.load(scene_, ignore).scene.mesh.materials.back().base_color.g, 0.75, 1e-6);
  EXPECT_EQ(builder.times_made(ScenePart::mesh), 2);
}

TEST_F(SceneBuild, ProbeEvDoublesEverythingTheLightGives) {
  const BuiltScene plain = build();
  scene_.probe.ev = 1;
  const BuiltScene brighter = build();
  EXPECT_NEAR(tag_irradiance_over_pi(brighter, {}).g, 2 * tag_irradiance_over_pi(plain, {}).g, 1e-6);
  EXPECT_NEAR(brighter.scene.light.at(0).g, 2 * plain.scene.light.at(0).g, 1e-6);
  EXPECT_NEAR(brighter.scene.reflections.levels.at(0).data.at(0), 2 * plain.scene.reflections.levels.at(0).data.at(0), 1e-6);
}

/// Band 1 of the light points where the lamp is: probe up is tag +z on a table, tag +y on a wall.
TEST_F(SceneBuild, UpSaysWhichTagAxisTheSkyIsAbove) {
  write_probe([](const glm::dvec3& d) { return glm::vec3(d.y > 0.5 ? 1.0f : 0.0f); });
  const auto light_at = [](const BuiltScene& built, int m) {
    return built.scene.light.at(static_cast<std::size_t>(render::sh_index(1, m))).g;
  };
  const BuiltScene table = build();
  EXPECT_GT(light_at(table, 0), 0.3);
  EXPECT_NEAR(light_at(table, -1), 0, 1e-3);
  scene_.probe.up = render::UpAxis::y;
  const BuiltScene wall = build();
  EXPECT_GT(light_at(wall, -1), 0.3);
  EXPECT_NEAR(light_at(wall, 0), 0, 1e-3);
}

/// A sky above the camera lights a tag that lies under it and not one that is held upside down.
TEST_F(SceneBuild, LightFixedToTheCameraTurnsAgainstTheTag) {
  write_probe([](const glm::dvec3& d) { return glm::vec3(d.y > 0.5 ? 1.0f : 0.0f); });
  scene_.probe.fixed_to = LightFrame::camera;
  const BuiltScene built = build();
  RigidTransform camera_from_tag;  // tag +z to camera -y, which is up
  camera_from_tag.rotation = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0));
  const double level = tag_irradiance_over_pi(built, camera_from_tag).g;
  EXPECT_GT(level, 0.5);
  camera_from_tag.rotation = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0));
  EXPECT_EQ(tag_irradiance_over_pi(built, camera_from_tag).g, 0);
}

/// With the tag's frame and the camera's related as a table's, both ways of fixing the light are the same light.
TEST_F(SceneBuild, LightFixedToTheCameraAgreesWithTheTagsInACommonPose) {
  write_probe([](const glm::dvec3& d) { return glm::vec3(1.0 + 0.5 * d.x + 0.3 * d.y, 1.0 - 0.4 * d.z, 1.0); });
  const BuiltScene still = build();
  scene_.probe.fixed_to = LightFrame::camera;
  const BuiltScene carried = build();
  // The camera looks horizontally along tag +y, as the probe's does along probe -z: x right, z = tag +y, y = tag -z.
  RigidTransform camera_from_tag;
  camera_from_tag.rotation = glm::transpose(glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0)));
  const glm::dvec3 a = tag_irradiance_over_pi(still, camera_from_tag), b = tag_irradiance_over_pi(carried, camera_from_tag);
  const render::ShRgb turned =
      render::rotate_sh(carried.scene.light, carried.orientation.tag_from_light(camera_from_tag.rotation));
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(a[c], b[c], 1e-9);
    for (std::size_t i = 0; i < turned.size(); ++i)
      EXPECT_NEAR(turned[i][c], still.scene.light[i][c], 1e-5) << "coefficient " << i;
  }
}

TEST_F(SceneBuild, TagFromLightIsTheIdentityUnlessTheLightFollowsTheCamera) {
  RigidTransform camera_from_tag;
  camera_from_tag.rotation = glm::dmat3(glm::rotate(glm::dmat4(1.0), 1.0, glm::dvec3(0, 0, 1)));
  EXPECT_EQ(build().orientation.tag_from_light(camera_from_tag.rotation), glm::dmat3(1.0));
}

TEST_F(SceneBuild, EdgesAreShortAgainstTheObject) {
  const render::Mesh mesh = load_objects(scene_, ignore);
  const double diagonal_m = std::hypot(0.02, 0.02);
  ASSERT_GT(mesh.vertices.size(), 100u);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const double edge_m = glm::distance(mesh.vertices[mesh.indices[i]].position_m, mesh.vertices[mesh.indices[next]].position_m);
    EXPECT_LE(edge_m, diagonal_m / 24 * 1.0001);
  }
}

TEST_F(SceneBuild, ObjectsArePlacedAndJoined) {
  scene_.objects.push_back(scene_.objects[0]);
  scene_.objects[1].translation_m = {0.1, 0, 0};
  double right_m = -1, left_m = 1;
  for (const render::Vertex& vertex : load_objects(scene_, ignore).vertices) {
    right_m = std::max<double>(right_m, vertex.position_m.x);
    left_m = std::min<double>(left_m, vertex.position_m.x);
  }
  EXPECT_NEAR(left_m, -0.01, 1e-6);
  EXPECT_NEAR(right_m, 0.11, 1e-6);
}

TEST_F(SceneBuild, ObjectsThatSlideOnTheReceiverTakeTheirTransferAlong) {
  SceneBuilder builder;
  scene_.objects.push_back(scene_.objects[0]);
  scene_.objects[1].translation_m = {0.05, 0, 0};
  const BuiltScene before = builder.build(scene_, ignore, {});
  for (SceneSettings::Object& object : scene_.objects) object.translation_m += glm::dvec3(0.0625, -0.125, 0);
  EXPECT_FALSE(builder.needs_bake(scene_));
  const BuiltScene after = builder.build(scene_, ignore, {});
  EXPECT_EQ(after.version, before.version) << "nothing that is drawn was made anew";
  EXPECT_EQ(after.tag_from_scene.translation_m, glm::dvec3(0.0625, -0.125, 0));
  EXPECT_EQ(after.tag_from_scene.rotation, glm::dmat3(1.0));

  scene_.objects[1].translation_m.x += 0.01;
  EXPECT_TRUE(builder.needs_bake(scene_)) << "they light each other otherwise";
  scene_.objects[1].translation_m.x -= 0.01;
  for (SceneSettings::Object& object : scene_.objects) object.translation_m.z += 0.01;
  EXPECT_TRUE(builder.needs_bake(scene_)) << "the receiver is farther away";
  EXPECT_GT(builder.build(scene_, ignore, {}).version, before.version);
}

TEST_F(SceneBuild, SecondBuildTakesTheTransferFromTheCache) {
  const BuiltScene first = build(), second = build();
  EXPECT_FALSE(first.transfer_was_cached);
  EXPECT_TRUE(second.transfer_was_cached);
  EXPECT_EQ(first.scene.transfer.object, second.scene.transfer.object);
  scene_.quality.bounces = 1;
  EXPECT_FALSE(build().transfer_was_cached) << "another bake was taken for this one";
}

TEST_F(SceneBuild, WhatCostsLessThanLightLeavesTheSceneAsItIs) {
  const BuiltScene before = build();
  change_all({ChangeCost::view, ChangeCost::passes, ChangeCost::track, ChangeCost::footage});
  const BuiltScene after = build();
  EXPECT_EQ(after.scene.transfer_key, before.scene.transfer_key);
  EXPECT_EQ(after.probe.image.data, before.probe.image.data);
  EXPECT_EQ(after.orientation.light_from_probe, before.orientation.light_from_probe);
  EXPECT_EQ(after.orientation.fixed_from_light, before.orientation.fixed_from_light);
  EXPECT_EQ(after.orientation.follows_camera, before.orientation.follows_camera);
  EXPECT_EQ(after.scene.light, before.scene.light);
  EXPECT_EQ(after.scene.lights.size(), before.scene.lights.size());
  EXPECT_EQ(after.scene.probe_in_tag_m, before.scene.probe_in_tag_m);
}

TEST_F(SceneBuild, WhatCostsLightLeavesTheMeshAsItIs) {
  const BuiltScene before = build();
  change_all({ChangeCost::light});
  const BuiltScene after = build();
  EXPECT_NE(after.scene.light, before.scene.light);
  EXPECT_EQ(after.scene.mesh.indices, before.scene.mesh.indices);
  EXPECT_EQ(after.scene.probe_in_tag_m, before.scene.probe_in_tag_m);
}

TEST_F(SceneBuild, WithoutReceiverThereIsNoShadow) {
  EXPECT_EQ(build().scene.transfer.grid.columns, 4);
  scene_.receiver.plane = ReceiverPlane::none;
  EXPECT_EQ(build().scene.transfer.grid.columns, 0);
}

TEST_F(SceneBuild, PlanSaysWhatWasChosenAndWhy) {
  const auto entry = [](const BuiltScene& built, const std::string& choice) {
    for (const PlanEntry& candidate : built.plan)
      if (candidate.choice == choice) return candidate.value + ": " + candidate.reason;
    return std::string("not in the plan");
  };
  EXPECT_EQ(entry(build(), "rays"), "16: set by hand");
  scene_.by_hand.clear();
  scene_.quality.tolerance = 0.05;
  EXPECT_EQ(entry(build(), "rays"), "128: for a tolerance of 0.05");
  EXPECT_EQ(entry(build(), "bands"), "2: default");
}

TEST_F(SceneBuild, LightThatNobodyChoseIsAGuessAndSaidToBeOne) {
  std::string said;
  scene_.probe.image = SceneSettings().probe.image;
  SceneBuilder guessing;
  const auto take = [&](const std::string& warning) { said += warning; };
  const BuiltScene& built = guessing.load(scene_, take);
  EXPECT_THAT(said, AllOf(HasSubstr("\"studio\" is a guess"), HasSubstr("--probe.image FILE")));
  EXPECT_EQ(built.plan.front().choice + ": " + built.plan.front().reason, "probe: a guess: none is given");
  EXPECT_TRUE(built.probe.image.data == render::make_probe("studio").image.data);
  said.clear();
  scene_.by_hand.insert("probe.image");
  EXPECT_EQ(guessing.load(scene_, take).plan.front().reason, "set by hand");
  EXPECT_EQ(said, "");
}

TEST_F(SceneBuild, MissingPiecesSayHowToSupplyThem) {
  const auto built = [this] { build(); };
  scene_.probe.image = "none.exr";
  EXPECT_THAT(message_of<Error>(built), HasSubstr(folder_.path("none.exr")));
  scene_.probe.image = folder_.path("studo");
  EXPECT_THAT(message_of<Error>(built), AllOf(StartsWith(folder_.path("studo")), HasSubstr("did you mean \"studio\"?")));
  scene_.probe.image = "sky:turbidity=40";
  EXPECT_THAT(message_of<Error>(built), StartsWith("sky:turbidity=40: turbidity is 40"));
  scene_.probe.image = "probe.exr";
  scene_.objects[0].mesh = "none.obj";
  EXPECT_THAT(message_of<Error>(built), HasSubstr(folder_.path("none.obj")));
  scene_.objects.clear();
  EXPECT_THAT(message_of<Error>(built), HasSubstr("--object.mesh FILE"));
}

}  // namespace
}  // namespace catchlight::app
