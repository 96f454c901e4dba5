#include "app/window/editing/light_drag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "app/session/scene_files.hpp"

namespace catchlight::app {
namespace {

constexpr double kDegree = glm::pi<double>() / 180;
const glm::dvec3 kUp(0, 0, 1);

glm::dvec3 direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree, e = elevation_deg * kDegree;
  return {std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)};
}

glm::dvec2 flat(double azimuth_deg) {
  return {std::cos(azimuth_deg * kDegree), std::sin(azimuth_deg * kDegree)};
}

/// Rodrigues' formula.
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double angle_deg) {
  const double a = angle_deg * kDegree;
  return std::cos(a) * v + std::sin(a) * glm::cross(axis, v) + (1 - std::cos(a)) * glm::dot(axis, v) * axis;
}

TEST(ShadowDrag, PutsTheLightOppositeToThePointer) {
  for (const double azimuth_deg : {-170.0, -20.0, 35.0, 160.0})
    for (const double pointer_deg : {-120.0, 0.0, 77.0, 180.0}) {
      SceneSettings start;
      start.probe.yaw_deg = 15;
      const glm::dvec2 foot_m(0.02, -0.01);
      const ShadowDrag drag(start, direction(azimuth_deg, 40), kUp, foot_m);
      const SceneSettings now = drag.at(foot_m + 0.07 * flat(pointer_deg));
      const double light_deg = azimuth_deg + now.probe.yaw_deg - start.probe.yaw_deg;
      EXPECT_NEAR(std::remainder(light_deg - (pointer_deg + 180), 360.0), 0, 0.101);
      EXPECT_TRUE(now.is_by_hand("probe.yaw_deg"));
    }
}

TEST(ShadowDrag, OverTheFootAllIsAsItBegan) {
  SceneSettings start;
  start.probe.yaw_deg = 12;
  EXPECT_EQ(ShadowDrag(start, direction(10, 30), kUp, {0.1, 0}).at({0.1, 0}).probe.yaw_deg, 12);
}

/// On a wall the light goes up and down with the turn, too: of all angles none throws the shadow nearer to the pointer.
TEST(TurnForShadow, IsTheBestOfAllAnglesWhicheverAxisIsUp) {
  const auto missed = [](const glm::dvec3& light, const glm::dvec2& shadow) {
    return light.z > 0 ? glm::dot(glm::normalize(glm::dvec2(light)), shadow) : 1;
  };
  for (const glm::dvec3& up : {kUp, glm::dvec3(0, 1, 0), glm::normalize(glm::dvec3(0.3, 0.8, 0.5))})
    for (const double pointer_deg : {-100.0, -60.0, 200.0, 290.0}) {
      const glm::dvec3 light = direction(40, 35);
      const glm::dvec2 shadow = flat(pointer_deg);
      double least = 1;
      for (double angle = -180; angle < 180; angle += 0.3) least = std::min(least, missed(turned(light, up, angle), shadow));
      const double found = missed(turned(light, up, turn_for_shadow_deg(light, up, shadow)), shadow);
      EXPECT_LT(found, least + 1e-6) << up.x << " " << pointer_deg;
    }
}

TEST(TurnForShadow, IsNoneForALightOnTheAxis) {
  EXPECT_EQ(turn_for_shadow_deg(kUp, kUp, {1, 0}), 0);
}

TEST(StrongestLight, IsWhatFallsOnTheTagMost) {
  const std::vector<render::LightSummary> lights{
      {direction(0, -30), glm::dvec3(9), 0.5}, {direction(0, 10), glm::dvec3(3), 0.2}, {direction(90, 80), glm::dvec3(2), 0.1}};
  EXPECT_EQ(strongest_light(lights, glm::dmat3(1)), &lights[2]);
  const glm::dmat3 upside_down(1, 0, 0, 0, -1, 0, 0, 0, -1);
  EXPECT_EQ(strongest_light(lights, upside_down), &lights[0]);
  EXPECT_EQ(strongest_light({}, glm::dmat3(1)), nullptr);
}

/// What the drag turns is what the scene turns.
TEST(ProbeTurned, TurnsTheLightAboutUp) {
  SceneSettings settings;
  settings.probe.yaw_deg = 170;
  const glm::dvec3 before = light_orientation(settings.probe).tag_from_light(glm::dmat3(1)) * direction(10, 20);
  settings = with_probe_turned(settings, 30);
  EXPECT_EQ(settings.probe.yaw_deg, -160);
  const glm::dvec3 after = light_orientation(settings.probe).tag_from_light(glm::dmat3(1)) * direction(10, 20);
  EXPECT_LT(glm::distance(after, turned(before, kUp, 30)), 1e-12);
}

}  // namespace
}  // namespace catchlight::app
