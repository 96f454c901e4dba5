#include "render/mesh/test_objects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/mesh/bounds.hpp"

namespace catchlight::render {
namespace {

constexpr double kTag_m = 0.08, kWidth_m = 0.06;

Mesh named(const std::string& name) {
  return test_object(name, kTag_m).value();
}

/// By the divergence theorem: positive where all faces wind counter-clockwise seen from outside.
double volume_m3(const Mesh& mesh) {
  double volume = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return glm::dvec3(mesh.vertices[mesh.indices[i + k]].position_m); };
    volume += glm::dot(corner(0), glm::cross(corner(1), corner(2))) / 6;
  }
  return volume;
}

TEST(TestObjects, ShapesHaveTheirVolumes) {
  const double r = kWidth_m / 2, tube = r / 4, pi = std::numbers::pi;
  const auto expect_volume = [](const char* name, double expected) {
    EXPECT_NEAR(volume_m3(named(name)) / expected, 1, 0.005) << name;
  };
  expect_volume("sphere", 4.0 / 3 * pi * r * r * r);
  expect_volume("cube", kWidth_m * kWidth_m * kWidth_m);
  expect_volume("cone", pi * r * r * kWidth_m / 3);
  expect_volume("cylinder", pi * r * r * kWidth_m);
  expect_volume("torus", 2 * pi * pi * (r - tube) * tube * tube);
}

TEST(TestObjects, ShapesAreAsWideAsSaidAndNormalsLookOutwards) {
  for (const char* name : {"sphere", "cube", "cone", "cylinder", "plane", "torus"}) {
    const Mesh mesh = named(name);
    const Bounds box = bounds_of(mesh);
    EXPECT_NEAR(box.max_m.x - box.min_m.x, kWidth_m, 1e-6) << name;
    EXPECT_NEAR(box.max_m.z + box.min_m.z, 0, 1e-6) << name;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const auto vertex = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]]; };
      const glm::vec3 face = glm::cross(vertex(1).position_m - vertex(0).position_m, vertex(2).position_m - vertex(0).position_m);
      EXPECT_GT(glm::length(face), 0) << name << ": a triangle without area";
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GT(glm::dot(face, vertex(k).normal), 0) << name;
        EXPECT_NEAR(glm::length(vertex(k).normal), 1, 1e-5) << name;
      }
    }
  }
}

TEST(TestObjects, OthersAreNone) {
  EXPECT_FALSE(test_object("Cube", kTag_m));
  EXPECT_FALSE(test_object("teapot", kTag_m));
}

}  // namespace
}  // namespace catchlight::render
