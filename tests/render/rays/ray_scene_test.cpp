#include "render/rays/ray_scene.hpp"
#include "tests/support/shapes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace catchlight::render {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Rays from a place between two balls, so that some hit either, some from behind, and most nothing. The number is odd: the last
/// packet is not full.
RayStream rays_between_balls() {
  std::mt19937 random(7);
  std::normal_distribution<float> spread;
  RayStream rays;
  rays.resize(4001);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::vec3 origin_m = i % 5 == 0 ? glm::vec3(0, 0, 3) : glm::vec3(0, 0, 1.5f);
    rays.set(i, origin_m, glm::normalize(glm::vec3(spread(random), spread(random), spread(random))), 0, kInfinity);
  }
  return rays;
}

Mesh two_balls() {
  Mesh mesh = sphere({0, 0, 0}, 1, 24);
  append(mesh, sphere({0, 0, 3}, 1, 24));
  return mesh;
}

class RayStreams : public testing::TestWithParam<Coherence> {};
INSTANTIATE_TEST_SUITE_P(, RayStreams, testing::Values(Coherence::coherent, Coherence::incoherent));

TEST_P(RayStreams, FindWhatSingleRaysFind) {
  const Mesh mesh = two_balls();
  const RayScene scene(mesh);
  RayStream rays = rays_between_balls();
  scene.closest_hits(rays, GetParam());
  int hits = 0, backs = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto alone = scene.closest_hit(rays.origin_m(i), rays.direction(i));
    ASSERT_EQ(rays.meets(i), alone.has_value()) << i;
    if (!alone) continue;
    ++hits, backs += !alone->front_facing;
    EXPECT_EQ(rays.triangle[i], alone->triangle);
    EXPECT_EQ(rays.is_front_facing(i), alone->front_facing);
    EXPECT_NEAR(rays.u[i], alone->u, 1e-4);
    EXPECT_NEAR(rays.v[i], alone->v, 1e-4);
    const std::uint32_t* corner = &mesh.indices[3 * alone->triangle];
    const glm::vec3 met_m = (1 - rays.u[i] - rays.v[i]) * mesh.vertices[corner[0]].position_m +
                            rays.u[i] * mesh.vertices[corner[1]].position_m + rays.v[i] * mesh.vertices[corner[2]].position_m;
    EXPECT_LT(glm::distance(met_m, rays.origin_m(i) + rays.far[i] * rays.direction(i)), 1e-5);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(backs, 500);  // from within the upper ball
}

TEST_P(RayStreams, AreBlockedWhereSingleRaysAre) {
  const Mesh mesh = two_balls();
  const RayScene scene(mesh);
  RayStream rays = rays_between_balls();
  scene.find_occluded(rays, GetParam());
  for (std::size_t i = 0; i < rays.size(); ++i)
    EXPECT_EQ(rays.far[i] < 0, scene.occluded(rays.origin_m(i), rays.direction(i))) << i;
}

TEST_P(RayStreams, MeetNothingBeforeTheirStartOrBeyondTheirEnd) {
  const Mesh mesh = two_balls();
  const RayScene scene(mesh);
  const auto along_z = [](float from, float to) {
    RayStream rays;
    rays.resize(1);
    rays.set(0, {0.01f, 0.02f, -5}, {0, 0, 1}, from, to);
    return rays;
  };
  const auto first_hit_m = [&](float from, float to) {
    RayStream rays = along_z(from, to);
    scene.closest_hits(rays, GetParam());
    return rays.meets(0) ? rays.far[0] : -1;
  };
  const auto is_blocked = [&](float from, float to) {
    RayStream rays = along_z(from, to);
    scene.find_occluded(rays, GetParam());
    return rays.far[0] < 0;
  };
  EXPECT_NEAR(first_hit_m(0, kInfinity), 4, 0.01);     // the lower ball's nearer side
  EXPECT_NEAR(first_hit_m(4.5f, kInfinity), 6, 0.01);  // its farther one
  EXPECT_NEAR(first_hit_m(6.5f, kInfinity), 7, 0.01);  // the upper ball
  EXPECT_EQ(first_hit_m(0, 3.9f), -1);
  EXPECT_EQ(first_hit_m(6.1f, 6.9f), -1);  // the gap
  EXPECT_TRUE(is_blocked(0, kInfinity));
  EXPECT_TRUE(is_blocked(4.5f, 6.5f));
  EXPECT_FALSE(is_blocked(0, 3.9f));
  EXPECT_FALSE(is_blocked(6.1f, 6.9f));
}

}  // namespace
}  // namespace catchlight::render
