#include "render/math/hemisphere_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace catchlight::render {
namespace {

TEST(HemisphereRays, AreNestedAndWellSpread) {
  // Each of the first 2^k points of Sobol's sequence falls into another cell of every dyadic grid of 2^k cells, scrambled or not.
  for (const std::uint32_t seed : {1u, 99u}) {
    for (const int columns : {1, 2, 4, 8, 16, 32, 64, 128, 256}) {
      std::vector<int> hits(256);
      for (std::uint32_t k = 0; k < 256; ++k) {
        const glm::dvec2 at = scrambled_sobol(k, seed);
        ++hits[static_cast<int>(at.x * columns) * (256 / columns) + static_cast<int>(at.y * (256 / columns))];
      }
      EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), 256) << columns << " columns";
    }
  }
}

/// All rays of one point.
struct Rays {
  std::vector<float> x, y, z;
  explicit Rays(int count) : x(count), y(count), z(count) {}
  HemisphereRays::Directions lanes() { return {x, y, z}; }
  glm::vec3 direction(std::size_t k) const { return {x[k], y[k], z[k]}; }
};

const glm::vec3 kNormals[] = {{0, 0, 1}, {0, 0, -1}, {0.9f, -0.3f, 0.3f}, {1, -2, 0.5f}};

TEST(HemisphereRays, FollowTheCosine) {
  for (const glm::vec3& normal : kNormals) {
    Rays rays(4096);
    HemisphereRays(4096).fill_hemisphere(normal, 3, rays.lanes());
    double mean_cos = 0;
    glm::dvec3 mean(0);
    for (std::size_t k = 0; k < 4096; ++k) {
      EXPECT_NEAR(glm::length(rays.direction(k)), 1, 1e-6);
      mean_cos += glm::dot(rays.direction(k), glm::normalize(normal)) / 4096;
      mean += glm::dvec3(rays.direction(k)) / 4096.0;
    }
    EXPECT_NEAR(mean_cos, 2.0 / 3, 1e-3);
    EXPECT_LT(glm::distance(mean, glm::dvec3(glm::normalize(normal)) * (2.0 / 3)), 2e-3);
  }
}

TEST(HemisphereRays, FillAConeEvenly) {
  for (const double half_angle_rad : {0.001, 0.1, 0.7}) {
    for (const glm::vec3& normal : kNormals) {
      const double cos_cone = std::cos(half_angle_rad);
      Rays rays(1024);
      HemisphereRays(1024).fill_cone(normal, cos_cone, 3, rays.lanes());
      double mean_height = 0;  // above the axis, as a share of the cap's: uniform on the sphere is uniform in height
      for (std::size_t k = 0; k < 1024; ++k) {
        EXPECT_NEAR(glm::length(rays.direction(k)), 1, 1e-6);
        const double aside = glm::length(glm::cross(glm::dvec3(rays.direction(k)), glm::normalize(glm::dvec3(normal))));
        EXPECT_LT(aside, std::sin(half_angle_rad) * 1.001);
        mean_height += (1 - std::sqrt(1 - aside * aside)) / (1 - cos_cone) / 1024;
      }
      EXPECT_NEAR(mean_height, 0.5, 2e-3) << half_angle_rad;
    }
  }
}

// Malley's method in double precision, about +z, whose frame is the axes.
glm::dvec3 lifted(const glm::dvec2& square) {
  const double radius = std::sqrt(square.x), phi = 2 * std::numbers::pi * square.y;
  return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - square.x)};
}

TEST(HemisphereRays, AreThePointsOfTheSequenceInAnotherOrder) {
  for (const int count : {1, 15, 64, 100, 1024}) {
    Rays rays(count);
    HemisphereRays(count).fill_hemisphere({0, 0, 1}, 77, rays.lanes());
    std::vector<glm::dvec3> expected(count), found(count);
    for (int k = 0; k < count; ++k) expected[k] = lifted(scrambled_sobol(k, 77)), found[k] = rays.direction(k);
    // No two heights are near enough to be taken for one another: Sobol's points fall into different rows.
    std::ranges::sort(expected, {}, &glm::dvec3::z);
    std::ranges::sort(found, {}, &glm::dvec3::z);
    for (int k = 0; k < count; ++k) EXPECT_LT(glm::distance(expected[k], found[k]), 1e-6) << count << ' ' << k;
  }
}

TEST(HemisphereRays, TheFirstAreThoseOfFewerRays) {
  constexpr int kMany = 512, kFew = 128;
  Rays many(kMany), few(kFew);
  HemisphereRays of_many(kMany), of_few(kFew);
  of_many.fill_hemisphere({0.6f, 0, 0.8f}, 11, many.lanes());
  of_few.fill_hemisphere({0.6f, 0, 0.8f}, 11, few.lanes());
  std::vector<glm::vec3> by_number(kFew);
  for (int i = 0; i < kFew; ++i) by_number[of_few.numbers()[i]] = few.direction(i);
  int found = 0;
  for (int i = 0; i < kMany; ++i) {
    const std::uint32_t number = of_many.numbers()[i];
    if (number >= kFew) continue;
    EXPECT_EQ(many.direction(i), by_number[number]);
    ++found;
  }
  EXPECT_EQ(found, kFew);
}

TEST(HemisphereRays, NeighboursGoTheSameWay) {
  Rays rays(1024);
  HemisphereRays(1024).fill_hemisphere({0, 0, 1}, 5, rays.lanes());
  double sorted = 0, far_apart = 0;
  for (std::size_t k = 0; k < 1024; ++k) {
    sorted += glm::distance(rays.direction(k), rays.direction(k / 16 * 16)) / 1024;
    far_apart += glm::distance(rays.direction(k), rays.direction((k + 341) % 1024)) / 1024;
  }
  EXPECT_LT(sorted, far_apart / 4);
}

}  // namespace
}  // namespace catchlight::render
