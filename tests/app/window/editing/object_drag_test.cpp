#include "app/window/editing/object_drag.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

#include "catchlight/projection.hpp"

namespace catchlight::app {
namespace {

/// 0.5 m above the tag, looking down at a slant.
RigidTransform slanted() {
  const double c = std::cos(0.6), s = std::sin(0.6);
  return {glm::dmat3(1, 0, 0, 0, -c, s, 0, -s, -c), {0.02, -0.03, 0.5}};
}

CameraModel camera(double k1) {
  CameraModel model{.width_px = 640, .height_px = 480, .fx_px = 600, .fy_px = 590, .cx_px = 310, .cy_px = 250};
  model.distortion[0] = k1;
  return model;
}

SceneSettings with_object() {
  SceneSettings settings;
  settings.objects.emplace_back();
  settings.objects[0].translation_m = {0.01, 0.02, 0.03};
  settings.objects[0].rotation_deg = {90, 0, 20};
  settings.objects[0].scale = 2;
  return settings;
}

TEST(SeenPlace, IsWhereThePixelComesFrom) {
  for (const double k1 : {0.0, -0.2, 0.1})
    for (const glm::dvec2& place : {glm::dvec2(0, 0), {0.05, -0.04}, {-0.06, 0.08}}) {
      const auto pixel = project_px(camera(k1), slanted() * glm::dvec3(place, 0));
      ASSERT_TRUE(pixel);
      const auto seen = seen_place_m(camera(k1), slanted(), *pixel);
      ASSERT_TRUE(seen);
      EXPECT_LT(glm::distance(*seen, place), 1e-7);
    }
}

TEST(SeenPlace, IsNoneAboveTheHorizonAndFromBelow) {
  EXPECT_FALSE(seen_place_m(camera(0), slanted(), {310, -2000}));
  RigidTransform below = slanted();
  below.translation_m = below.rotation * glm::dvec3(0, 0, 0.5);
  EXPECT_FALSE(seen_place_m(camera(0), below, {310, 250}));
}

TEST(ObjectDrag, MovesWithThePointer) {
  const ObjectDrag drag(with_object(), 0, DragKind::move, {0.1, 0.1});
  const SceneSettings moved = drag.at({0.13, 0.08});
  EXPECT_LT(glm::distance(moved.objects[0].translation_m, glm::dvec3(0.04, 0, 0.03)), 1e-12);
  EXPECT_TRUE(moved.is_by_hand(drag.key()));
  EXPECT_EQ(drag.at({0.1, 0.1}).objects[0].translation_m, with_object().objects[0].translation_m);
}

TEST(ObjectDrag, TurnsAroundTheOrigin) {
  const ObjectDrag drag(with_object(), 0, DragKind::turn, {0.11, 0.02});
  const SceneSettings turned = drag.at({0.01, 0.12});
  EXPECT_NEAR(turned.objects[0].rotation_deg.z, 110, 1e-9);
  EXPECT_EQ(turned.objects[0].rotation_deg.x, 90);
}

TEST(ObjectDrag, ScalesByTheDistance) {
  const ObjectDrag drag(with_object(), 0, DragKind::scale, {0.06, 0.02});
  EXPECT_NEAR(drag.at({0.11, 0.02}).objects[0].scale, 4, 1e-9);
  EXPECT_GT(drag.at({0.01, 0.02}).objects[0].scale, 0) << "a drag over the origin keeps the object";
  EXPECT_EQ(ObjectDrag::text(drag.at({0.11, 0.02}), 0, DragKind::scale), "× 4.000");
}

}  // namespace
}  // namespace catchlight::app
