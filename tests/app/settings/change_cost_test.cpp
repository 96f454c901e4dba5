#include "app/settings/change_cost.hpp"
#include "app/settings/parameters.hpp"
#include "tests/support/parameter_values.hpp"

#include <gmock/gmock.h>

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

SceneSettings scene_with(std::size_t objects, std::size_t bundled = 0) {
  SceneSettings scene;
  scene.objects.resize(objects);
  scene.tag.bundle.resize(bundled);
  return scene;
}

TEST(ChangeCost, NothingChangedCostsNothing) {
  EXPECT_THAT(costs_of_change({}, {}), IsEmpty());
  EXPECT_THAT(costs_of_change(scene_with(2, 3), scene_with(2, 3)), IsEmpty());
}

TEST(ChangeCost, IsThatOfTheParameterThatChanged) {
  const SceneSettings before = scene_with(1, 1);
  for (const Parameter& parameter : parameters()) {
    SceneSettings after = before;
    set_parameter_from_text(after, parameter.key, tests::other_value(parameter));
    EXPECT_THAT(costs_of_change(before, after), ElementsAre(parameter.cost)) << parameter.key;
    EXPECT_THAT(costs_of_change(after, before), ElementsAre(parameter.cost)) << parameter.key << " back again";
  }
}

TEST(ChangeCost, SeveralChangesAddUp) {
  SceneSettings after;
  after.exposure.ev = 1;
  after.probe.yaw_deg = 20;
  after.probe.ev = 1;
  EXPECT_THAT(costs_of_change({}, after), ElementsAre(ChangeCost::view, ChangeCost::light));
}

TEST(ChangeCost, EveryObjectAndEveryFurtherTagCounts) {
  const SceneSettings before = scene_with(3, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    SceneSettings moved = before, another_tag = before;
    moved.objects[i].translation_m.z = 0.01;
    another_tag.tag.bundle[i].id = 7;
    EXPECT_THAT(costs_of_change(before, moved), ElementsAre(ChangeCost::mesh)) << "object " << i;
    EXPECT_THAT(costs_of_change(before, another_tag), ElementsAre(ChangeCost::track)) << "tag " << i;
  }
}

TEST(ChangeCost, OneMoreOrOneLessIsAChangeOfItsKind) {
  EXPECT_THAT(costs_of_change(scene_with(1), scene_with(2)), ElementsAre(ChangeCost::mesh));
  EXPECT_THAT(costs_of_change(scene_with(2), scene_with(1)), ElementsAre(ChangeCost::mesh));
  EXPECT_THAT(costs_of_change(scene_with(1, 0), scene_with(1, 1)), ElementsAre(ChangeCost::track));
}

TEST(ChangeCost, WhatOnlyAFileSaysCounts) {
  SceneSettings placed = scene_with(2), strict = scene_with(2), elsewhere = scene_with(2);
  placed.objects[1].matrix = glm::dmat4(1.0);
  strict.probe.strict = true;
  elsewhere.folder = "/elsewhere";
  EXPECT_THAT(costs_of_change(scene_with(2), placed), ElementsAre(ChangeCost::mesh));
  EXPECT_THAT(costs_of_change(scene_with(2), strict), ElementsAre(ChangeCost::light));
  EXPECT_THAT(costs_of_change(scene_with(2), elsewhere),
              ElementsAre(ChangeCost::passes, ChangeCost::light, ChangeCost::mesh, ChangeCost::footage))
      << "files of the same name in another folder are other files";
}

/// `quality.rays` by hand goes before what the tolerance asks for, even where it names the default.
TEST(ChangeCost, TakingAValueIntoOnesHandsIsAChange) {
  SceneSettings by_hand;
  set_parameter_from_text(by_hand, "quality.rays", "1024");
  ASSERT_EQ(by_hand.quality.rays, SceneSettings{}.quality.rays);
  EXPECT_THAT(costs_of_change({}, by_hand), ElementsAre(ChangeCost::bake));
}

}  // namespace
}  // namespace catchlight::app
