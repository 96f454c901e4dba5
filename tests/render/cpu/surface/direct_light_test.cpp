#include "render/cpu/surface/direct_light.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "render/mesh/bounds.hpp"
#include "render/render_scene.hpp"
#include "render/split_light.hpp"
#include "tests/support/brute_rays.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_files.hpp"

namespace catchlight::render {
namespace {

LightSample sample_of(const glm::dvec3& towards, const glm::dvec3& irradiance) {
  return {glm::normalize(towards), irradiance};
}

const std::vector<LightSample> kLamps{sample_of({0.3, 0.2, 1}, {1, 2, 3}), sample_of({-0.8, 0.1, 0.7}, {4, 1, 0.5}),
                                      sample_of({0.1, 0.9, 0.4}, {0.2, 0.3, 2}), sample_of({0.2, 0.1, -1}, {9, 9, 9})};

/// A floor of `cells` x `cells` quadrilaterals, 1 m wide, at z = 0.
Mesh floor_of(int cells) {
  Mesh mesh;
  mesh.materials.push_back(white());
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x)
      mesh.vertices.push_back({glm::vec3(glm::vec2(x, y) / static_cast<float>(cells) - 0.5f, 0), {0, 0, 1}});
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const auto a = static_cast<std::uint32_t>(y * (cells + 1) + x), b = a + static_cast<std::uint32_t>(cells) + 1;
      add_triangle(mesh, a, a + 1, b + 1);
      add_triangle(mesh, a, b + 1, b);
    }
  return mesh;
}

Mesh ball_over_floor() {
  Mesh mesh = floor_of(6);
  append(mesh, sphere({0, 0, 0.2f}, 0.1f, 16));
  return mesh;
}

SurfacePoint point_of(const Mesh& mesh, std::uint32_t triangle, const glm::vec2& weights) {
  const std::uint32_t* corner = &mesh.indices[3 * static_cast<std::size_t>(triangle)];
  SurfacePoint point;
  const glm::vec3 w(1 - weights.x - weights.y, weights);
  for (int k = 0; k < 3; ++k) {
    point.position_m += w[k] * mesh.vertices[corner[k]].position_m;
    point.normal += w[k] * mesh.vertices[corner[k]].normal;
  }
  point.normal = glm::normalize(point.normal);
  point.triangle = triangle;
  point.weights = weights;
  return point;
}

std::vector<SurfacePoint> random_points(const Mesh& mesh, std::uint32_t triangles, int count) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    glm::vec2 w(share(random), share(random));
    if (w.x + w.y > 1) w = 1.0f - w;
    points.push_back(point_of(mesh, static_cast<std::uint32_t>(random() % triangles), w));
  }
  return points;
}

/// What arrives at a place, a triangle at a time.
glm::dvec3 brute_irradiance(const Mesh& mesh, const glm::vec3& position_m, const glm::vec3& normal, float lift_m) {
  glm::dvec3 sum(0);
  for (const LightSample& sample : kLamps) {
    const double cosine = glm::dot(glm::dvec3(normal), sample.direction);
    if (cosine > 0 && !test::meets_any(mesh, position_m + lift_m * normal, glm::vec3(sample.direction)))
      sum += sample.irradiance * cosine;
  }
  return sum;
}

TEST(DirectLight, OfAnOpenPlaneIsTheSumOfIrradianceTimesCosine) {
  const Mesh mesh = floor_of(3);
  const RayScene rays(mesh);
  DirectLight light(mesh, rays, bounds_of(mesh));
  light.set_samples(kLamps, true);
  glm::dvec3 expected(0);
  for (int i = 0; i < 3; ++i) expected += kLamps[i].irradiance * kLamps[i].direction.z;
  for (const glm::vec3& vertex : light.at_vertices_over_pi())
    EXPECT_LT(glm::distance(glm::dvec3(vertex), expected / std::numbers::pi), 1e-5);
  std::array<float, kMaxLightSamples> shares{};
  for (const SurfacePoint& point : random_points(mesh, 18, 50)) {
    light.prepare({&point, 1});
    EXPECT_LT(glm::distance(glm::dvec3(light.irradiance(point, shares.data())), expected), 1e-5);
    EXPECT_NEAR(shares[0], 1, 1e-6);
    EXPECT_NEAR(shares[2], 1, 1e-6);
    EXPECT_EQ(shares[3], 0) << "from below";
  }
}

/// Holds random places of a floor under `above` against brute force; how many of them are in shadow.
int expect_shadows_on_floor(int cells, const Mesh& above, float step_m) {
  Mesh mesh = floor_of(cells);
  append(mesh, above);
  const RayScene rays(mesh);
  const Bounds bounds = bounds_of(mesh);
  DirectLight light(mesh, rays, bounds);
  light.set_samples(kLamps, true);
  const std::vector<SurfacePoint> points = random_points(mesh, static_cast<std::uint32_t>(2 * cells * cells), 3000);
  light.prepare(points);
  const float lift_m = 0.4f / 512 * bounds.diagonal_m();
  // A shadow's edge is as wide as a step of the lattice: there it need not be the same.
  int at_edges = 0, in_shadow = 0;
  for (const SurfacePoint& point : points) {
    const glm::dvec3 expected = brute_irradiance(mesh, point.position_m, point.normal, lift_m);
    bool at_edge = false;
    for (const glm::vec2& beside : {glm::vec2(1.5f, 0), {-1.5f, 0}, {0, 1.5f}, {0, -1.5f}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}})
      at_edge =
          at_edge || brute_irradiance(mesh, point.position_m + glm::vec3(beside * step_m, 0), point.normal, lift_m) != expected;
    at_edges += at_edge;
    in_shadow += expected.x < 3;
    if (!at_edge) {
      EXPECT_LT(glm::distance(glm::dvec3(light.irradiance(point, nullptr)), expected), 1e-4)
          << point.position_m.x << ", " << point.position_m.y;
    }
  }
  EXPECT_LT(at_edges, 300);
  return in_shadow;
}

TEST(DirectLight, IsInShadowWhereRaysAreBlocked) {
  EXPECT_GT(expect_shadows_on_floor(16, box({-0.1f, -0.08f, 0.1f}, {0.12f, 0.1f, 0.2f}), std::sqrt(2.0f) / 384), 100);
}

/// Two triangles, none of whose corners, middles of edges or middle lies in the shadow.
TEST(DirectLight, IsInShadowInTheMiddleOfALargeTriangle) {
  EXPECT_GT(expect_shadows_on_floor(1, box({0.1f, -0.27f, 0}, {0.16f, -0.21f, 0.16f}), std::sqrt(2.0f) / 96), 50);
}

/// Triangles of a coarse ball shade each other where light grazes them; the ball that their normals tell of does not.
TEST(DirectLight, OfACoarseRoundBallEndsWhereThatOfARoundOneDoes) {
  const Mesh mesh = sphere({0, 0, 0}, 0.1f, 16);
  const RayScene rays(mesh);
  DirectLight light(mesh, rays, bounds_of(mesh));
  const std::vector<LightSample> lamp{sample_of({0.3, 0.2, 1}, {1, 1, 1})};
  light.set_samples(lamp, true);
  const std::vector<SurfacePoint> points = random_points(mesh, static_cast<std::uint32_t>(mesh.indices.size() / 3), 2000);
  light.prepare(points);
  int lit = 0;
  for (const SurfacePoint& point : points) {
    const float expected = std::max(glm::dot(point.normal, glm::vec3(lamp[0].direction)), 0.0f);
    lit += expected > 0;
    EXPECT_NEAR(light.irradiance(point, nullptr).x, expected, 0.02f) << point.position_m.x << ", " << point.position_m.y;
  }
  EXPECT_GT(lit, 800);
}

TEST(DirectLight, OfABackFaceIsThatOfItsOwnSide) {
  const Mesh mesh = floor_of(4);
  const RayScene rays(mesh);
  DirectLight light(mesh, rays, bounds_of(mesh));
  light.set_samples(kLamps, true);
  SurfacePoint point = point_of(mesh, 5, {0.3f, 0.3f});
  point.normal = -point.normal;
  point.is_back = true;
  std::array<float, kMaxLightSamples> shares{};
  const glm::dvec3 expected = -kLamps[3].irradiance * kLamps[3].direction.z;
  EXPECT_LT(glm::distance(glm::dvec3(light.irradiance(point, shares.data())), expected), 1e-4);
  EXPECT_EQ(shares[0], 0);
  EXPECT_EQ(shares[3], 1);
}

TEST(DirectLight, DoesNotDependOnWhichPointsWereSeenBefore) {
  const Mesh mesh = ball_over_floor();
  const RayScene rays(mesh);
  const std::vector<SurfacePoint> points = random_points(mesh, 72, 400);
  DirectLight at_once(mesh, rays, bounds_of(mesh)), one_by_one(mesh, rays, bounds_of(mesh));
  at_once.set_samples(kLamps, true), one_by_one.set_samples(kLamps, true);
  at_once.prepare(points);
  for (std::size_t i = points.size(); i-- > 0;) {
    one_by_one.prepare({&points[i], 1});
    EXPECT_EQ(one_by_one.irradiance(points[i], nullptr), at_once.irradiance(points[i], nullptr));
  }
}

TEST(DirectLight, FollowsTheLight) {
  const Mesh mesh = floor_of(4);
  const RayScene rays(mesh);
  DirectLight light(mesh, rays, bounds_of(mesh));
  const SurfacePoint point = point_of(mesh, 3, {0.2f, 0.5f});
  light.set_samples(kLamps, true);
  light.prepare({&point, 1});
  light.set_samples({}, true);
  light.prepare({&point, 1});
  EXPECT_EQ(light.irradiance(point, nullptr), glm::vec3(0));
  EXPECT_TRUE(light.at_vertices_over_pi().empty());
  const std::vector<LightSample> one{sample_of({0, 0, 1}, {2, 2, 2})};
  light.set_samples(one, true);
  light.prepare({&point, 1});
  EXPECT_LT(glm::distance(light.irradiance(point, nullptr), glm::vec3(2)), 1e-6f);
}

TEST(DirectLight, HasRoomForAsManySamplesAsAScene) {
  const Mesh mesh = floor_of(2);
  const RayScene rays(mesh);
  DirectLight light(mesh, rays, bounds_of(mesh));
  const std::vector<LightSample> many(kMaxLightSamples, sample_of({0, 0, 1}, {0.5, 0.5, 0.5}));
  light.set_samples(many, true);
  const SurfacePoint point = point_of(mesh, 1, {0.2f, 0.5f});
  light.prepare({&point, 1});
  std::array<float, kMaxLightSamples> shares{};
  EXPECT_NEAR(light.irradiance(point, shares.data()).x, 0.5 * kMaxLightSamples, 1e-3);
  for (const float share : shares) EXPECT_NEAR(share, 1, 1e-6);
}

/// The light on a floor below a ball, and what of it the cache has.
class KeptDirectLight : public testing::Test {
 protected:
  /// The light at the points; `rays`: of what stands in its way where that must be found.
  std::vector<glm::vec3> light(const RayScene& rays, std::span<const SurfacePoint> points, const KeyedCache& kept) const {
    DirectLight direct(mesh_, rays, bounds_of(mesh_));
    direct.set_samples(kLamps, true, kept);
    direct.prepare(points);
    std::vector<glm::vec3> result;
    for (const SurfacePoint& point : points) result.push_back(direct.irradiance(point, nullptr));
    return result;
  }

  KeyedCache kept(const std::string& transfer) const {
    return {ContentCache(folder_ / "cache"), content_hash(transfer, {{}, {}, kLamps})};
  }

  TempFolder folder_;
  Mesh mesh_ = ball_over_floor(), open_ = floor_of(1);
  RayScene rays_{mesh_}, open_rays_{open_};
  std::vector<SurfacePoint> points_ = random_points(mesh_, 72, 400);
};

TEST_F(KeptDirectLight, IsTakenFromTheCache) {
  const std::vector<glm::vec3> found = light(rays_, points_, kept("transfer"));
  EXPECT_NE(found, light(open_rays_, points_, {})) << "nothing is in shadow";
  EXPECT_EQ(found, light(rays_, points_, {}));
  EXPECT_EQ(found, light(open_rays_, points_, kept("transfer"))) << "it was found anew";
}

TEST_F(KeptDirectLight, GrowsByWhatIsFoundBesides) {
  const std::span<const SurfacePoint> all(points_), some = all.first(10);
  light(rays_, some, kept("transfer"));
  const std::vector<glm::vec3> found = light(rays_, all, kept("transfer"));
  EXPECT_EQ(found, light(rays_, all, {}));
  EXPECT_EQ(found, light(open_rays_, all, kept("transfer"))) << "what was found besides was not added";
}

TEST_F(KeptDirectLight, IsFoundAnewWhereTheFileIsDamagedOrAnothers) {
  light(rays_, points_, kept("transfer"));
  const std::vector<glm::vec3> anew = light(open_rays_, points_, {});
  EXPECT_EQ(anew, light(open_rays_, points_, kept("another")));
  damage_all_in(folder_ / "cache");
  EXPECT_EQ(anew, light(open_rays_, points_, kept("transfer")));
}

}  // namespace
}  // namespace catchlight::render
