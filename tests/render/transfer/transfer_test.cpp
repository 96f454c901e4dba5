#include "render/transfer/transfer.hpp"
#include "catchlight/error.hpp"
#include "render/math/sh.hpp"
#include "tests/support/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

const ReceiverGrid kNoReceiver{};

TransferOptions with(int bands, int rays, int bounces = 0) {
  TransferOptions options;
  options.bands = bands, options.rays = rays, options.bounces = bounces;
  return options;
}

/// Irradiance / pi at vertex v under a sky of radiance 1.
double under_white_sky(const Transfer& transfer, std::size_t v) {
  return transfer.object[v * sh_count(transfer.bands)].x * 2 * std::sqrt(kPi);
}

/// Irradiance of receiver point p under that sky, as a share of the unshadowed one.
double open_share(const Transfer& transfer, std::size_t p) {
  return transfer.receiver[p * sh_count(transfer.bands)].x / transfer.receiver_unshadowed[0];
}

ReceiverGrid single_point(float x, float y) {
  return {{x, y}, {x, y}, 1, 1};
}

// ---- the furnace ----

TEST(WhiteFurnace, ConvexObjectIsLitByAllOfIt) {
  Mesh mesh = sphere({0, 0, 2}, 1, 24);
  mesh.materials[0].base_color = {0.7f, 0.45f, 0.25f};
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(4, 64), {});
  for (const std::uint32_t v : used_vertices(mesh)) EXPECT_NEAR(under_white_sky(transfer, v), 1, 1e-6) << "whatever its albedo";
}

TEST(WhiteFurnace, ConvexObjectHasTheClosedFormInAllBands) {
  const Mesh mesh = box({-1, -1, 0}, {1, 1, 2});
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(6, 64), {});
  std::vector<double> y(36);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    evaluate_sh(mesh.vertices[v].normal, 6, y);
    for (int l = 0; l < 6; ++l) {
      for (int m = -l; m <= l; ++m) {
        EXPECT_NEAR(transfer.object[v * 36 + sh_index(l, m)].y, cosine_lobe_over_pi(l) * y[sh_index(l, m)], 1e-6);
      }
    }
  }
}

TEST(WhiteFurnace, ClosedRoomIsDarkAtOnce) {
  const Mesh mesh = sphere({0, 0, 0}, 1, 16, true);
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(1, 256), {});
  for (const std::uint32_t v : used_vertices(mesh)) EXPECT_NEAR(under_white_sky(transfer, v), 0, 1e-5) << "no ray leaks out";
}

TEST(WhiteFurnace, BouncesApproachTheClosedFormOfAnOpenSphere) {
  // Inside a diffuse sphere all points see all others alike. With a lid taken off that covers the share s of its area, direct
  // light is s everywhere, and what arrives at the wall after k bounces is s (1 + q + ... + q^k) with q = rho (1 - s).
  Mesh whole = sphere({0, 0, 0}, 1, 20, true), bowl = whole;
  bowl.indices.clear(), bowl.triangle_material.clear();
  const double lid_z = std::cos(kPi * 5 / 20);  // five rows from the top
  for (std::size_t i = 0; i < whole.indices.size(); i += 3) {
    float top = -1;
    for (int k = 0; k < 3; ++k) top = std::max(top, whole.vertices[whole.indices[i + k]].position_m.z);
    if (top > lid_z + 1e-4) continue;
    bowl.indices.insert(bowl.indices.end(), whole.indices.begin() + i, whole.indices.begin() + i + 3);
    bowl.triangle_material.push_back(0);
  }
  bowl.materials[0].base_color = glm::vec3(0.8f);
  const double share = (1 - lid_z) / 2, q = 0.8 * (1 - share);
  double expected = share, term = expected;
  for (int bounces = 0; bounces <= 2; ++bounces) {
    const Transfer transfer = bake_transfer(bowl, kNoReceiver, with(1, 256, bounces), {});
    double mean = 0, weight = 0;
    for (const std::uint32_t v : bowl.indices) {  // by area: the rows near the poles have small triangles
      const double area = std::sqrt(1 - bowl.vertices[v].position_m.z * bowl.vertices[v].position_m.z);
      mean += area * under_white_sky(transfer, v), weight += area;
    }
    EXPECT_NEAR(mean / weight / expected, 1, 0.03) << bounces << " bounces: facets stand for a sphere, 256 rays";
    expected += term *= q;
  }
}

TEST(WhiteFurnace, WhiteWallsNeverGiveBackMoreThanTheSky) {
  Mesh mesh = sphere({0, 0, 1.5f}, 1, 16);
  append(mesh, box({-2, -2, -1}, {2, 2, 0}));
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(1, 256, 4), {});
  for (const std::uint32_t v : used_vertices(mesh)) EXPECT_LE(under_white_sky(transfer, v), 1 + 1e-5);
}

// ---- closed forms of shadows ----

TEST(ReceiverShadow, OfASphereHasItsFormFactor) {
  // Under a uniform sky a sphere of radius r whose middle is at height h, at horizontal distance d, takes (r/D)^2 h/D of the
  // cosine- weighted sky, D^2 = h^2 + d^2 (where it is wholly above the horizon).
  const Mesh mesh = blackened(sphere({0, 0, 1.5f}, 1, 96));
  for (const double d : {0.0, 0.7, 2.0, 5.0}) {
    const Transfer transfer = bake_transfer(mesh, single_point(static_cast<float>(d), 0), with(2, 4096), {});
    const double distance = std::sqrt(1.5 * 1.5 + d * d);
    EXPECT_NEAR(1 - open_share(transfer, 0), 1 / (distance * distance) * 1.5 / distance, 0.003)
        << "d = " << d << "; facets lie inside the sphere";
  }
}

TEST(ReceiverShadow, OfADiscHasItsFormFactor) {
  // Coaxial disc of radius r at height h: r^2 / (r^2 + h^2).
  for (const float height : {0.05f, 0.5f, 3.0f}) {
    const Transfer transfer = bake_transfer(blackened(disc({0, 0, height}, 1, 256)), single_point(0, 0), with(2, 4096), {});
    EXPECT_NEAR(1 - open_share(transfer, 0), 1 / (1 + height * height), 0.002) << "height " << height;
  }
}

TEST(ReceiverShadow, IsNothingWhereNothingIsInTheWay) {
  const Mesh mesh = box({-1, -1, -3}, {1, 1, -1});  // below the table
  const Transfer transfer = bake_transfer(mesh, {{-4, -4}, {4, 4}, 9, 9}, with(5, 64), {});
  for (std::size_t i = 0; i < transfer.receiver.size(); ++i)
    EXPECT_EQ(transfer.receiver[i].x, transfer.receiver_unshadowed[i % 25]);
}

TEST(ReceiverShadow, FadesToNothingAtTheRim) {
  const Mesh mesh = blackened(disc({0, 0, 0.5f}, 10, 64));
  const ReceiverGrid grid{{-1, -1}, {1, 1}, 17, 13};
  const Transfer transfer = bake_transfer(mesh, grid, with(2, 256), {});
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns; ++x) {
      const int from_rim = std::min({x, y, grid.columns - 1 - x, grid.rows - 1 - y});
      const double share = open_share(transfer, y * grid.columns + x);
      if (from_rim == 0) {
        EXPECT_EQ(share, 1.0);
      }
      if (from_rim >= 4) {
        EXPECT_LT(share, 0.02);
      }
    }
  }
}

TEST(ReceiverShadow, RedWallsColourTheTable) {
  Mesh mesh;
  add_quad(mesh, {0.1f, -1, 0}, {0.1f, -1, 2}, {0.1f, 1, 2}, {0.1f, 1, 0});  // faces -x
  subdivide_long_edges(mesh, 0.2, 10000);
  mesh.materials[0].base_color = {1, 0, 0};
  const Transfer dark = bake_transfer(mesh, single_point(-0.2f, 0), with(1, 1024, 0), {});
  const Transfer bled = bake_transfer(mesh, single_point(-0.2f, 0), with(1, 1024, 1), {});
  EXPECT_LT(open_share(dark, 0), 0.7);
  // The wall's light comes from all round, the probe's lower half included: what it hides comes back in full, in red alone.
  EXPECT_NEAR(bled.receiver[0].x, bled.receiver_unshadowed[0], 1e-4);
  EXPECT_NEAR(bled.receiver[0].y, dark.receiver[0].y, 1e-6);
}

TEST(ReceiverShadow, ContactLineIsNeitherBrightNorBlack) {
  // Points under a box that stands on the table are filled from outside; beside a tall wall half the sky is hidden.
  const Mesh mesh = blackened(box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1}));
  const ReceiverGrid grid{{-2, -2}, {2, 2}, 81, 81};
  const Transfer transfer = bake_transfer(mesh, grid, with(1, 512), {});
  const int middle = 40;
  for (int x = middle + 9; x <= middle + 10; ++x) {  // 0.45 and 0.5: inside, on the border
    EXPECT_GT(open_share(transfer, middle * 81 + x), 0.4) << x;
    EXPECT_LT(open_share(transfer, middle * 81 + x), 0.75) << x;
  }
  double before = 0;
  for (int x = middle + 11; x < 77; ++x) {
    const double share = open_share(transfer, middle * 81 + x);
    EXPECT_GT(share, before - 0.02) << "the shadow thins out with the distance";
    before = share;
  }
  EXPECT_GT(before, 0.93);
}

// ---- against brute force ----

bool moeller_trumbore(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a, const glm::dvec3& b,
                      const glm::dvec3& c) {
  const glm::dvec3 e1 = b - a, e2 = c - a, p = glm::cross(direction, e2);
  const double det = glm::dot(e1, p);
  if (std::abs(det) < 1e-14) return false;
  const glm::dvec3 t = origin - a, q = glm::cross(t, e1);
  const double u = glm::dot(t, p) / det, v = glm::dot(direction, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && glm::dot(e2, q) / det > 0;
}

// Plain Monte Carlo with visibility only: other rays, another caster, no control variate.
std::vector<double> reference_transfer(const Mesh& mesh, const Vertex& vertex, int bands, int rays) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> sum(sh_count(bands)), y(sh_count(bands));
  for (int k = 0; k < rays; ++k) {
    // A point of the unit sphere on top of the normal is cosine distributed.
    const glm::dvec3 on_sphere = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    const glm::dvec3 direction = glm::normalize(glm::dvec3(vertex.normal) + on_sphere);
    const glm::dvec3 origin = glm::dvec3(vertex.position_m) + 1e-5 * glm::dvec3(vertex.normal);
    bool open = true;
    for (std::size_t i = 0; open && i < mesh.indices.size(); i += 3) {
      const auto corner = [&](int c) { return glm::dvec3(mesh.vertices[mesh.indices[i + c]].position_m); };
      open = !moeller_trumbore(origin, direction, corner(0), corner(1), corner(2));
    }
    if (!open) continue;
    evaluate_sh(direction, bands, y);
    for (std::size_t i = 0; i < y.size(); ++i) sum[i] += y[i] / rays;
  }
  return sum;
}

TEST(Transfer, AgreesWithBruteForce) {
  Mesh mesh = box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1});
  append(mesh, sphere({1.4f, 0.2f, 0.8f}, 0.6f, 8));
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(4, 4096), {});
  constexpr int kRays = 20000;
  for (const std::size_t v : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{17}, mesh.vertices.size() - 60}) {
    const std::vector<double> expected = reference_transfer(mesh, mesh.vertices[v], 4, kRays);
    // |y| < 1.2 in four bands, hence sigma < 1.2 / sqrt(kRays); four of them.
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(transfer.object[v * 16 + i].x, expected[i], 4 * 1.2 / std::sqrt(kRays)) << v << ", " << i;
  }
}

TEST(Transfer, ErrorFallsFasterThanRandomRaysWould) {
  // Over 32 seeds, against 65536 rays: 16 times the rays must give less than a quarter of the error.
  const Mesh mesh = blackened(disc({0.3f, 0.1f, 0.7f}, 0.8f, 64));
  const double exact = open_share(bake_transfer(mesh, single_point(0, 0), with(1, 1 << 16), {}), 0);
  const auto rms_error = [&](int rays) {
    double sum = 0;
    for (std::uint32_t seed = 0; seed < 32; ++seed) {
      TransferOptions options = with(1, rays);
      options.seed = seed + 1;
      const double error = open_share(bake_transfer(mesh, single_point(0, 0), options, {}), 0) - exact;
      sum += error * error / 32;
    }
    return std::sqrt(sum);
  };
  const double coarse = rms_error(64), fine = rms_error(1024);
  EXPECT_LT(fine, coarse / 4);
  EXPECT_LT(coarse, 0.5 / std::sqrt(64)) << "no worse than random rays: sigma <= 1/2 each";
}

// ---- invariances ----

TEST(Transfer, IsTheSameForAnyNumberOfThreads) {
  Mesh mesh = sphere({0, 0, 1}, 1, 12);
  append(mesh, box({1, 1, 0}, {2, 2, 1}));
  TransferOptions one = with(4, 64, 1), five = one;
  one.threads = 1, five.threads = 5;
  const ReceiverGrid grid{{-3, -3}, {3, 3}, 20, 20};
  const Transfer a = bake_transfer(mesh, grid, one, {}), b = bake_transfer(mesh, grid, five, {});
  EXPECT_TRUE(a.object == b.object);
  EXPECT_TRUE(a.receiver == b.receiver);
}

TEST(Transfer, FewerBandsAreTheFirstOfMore) {
  Mesh mesh = sphere({0, 0, 1}, 1, 8);
  append(mesh, box({1, 1, 0}, {2, 2, 3}));
  const Transfer three = bake_transfer(mesh, kNoReceiver, with(3, 64), {}),
                 five = bake_transfer(mesh, kNoReceiver, with(5, 64), {});
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (int i = 0; i < 9; ++i) EXPECT_EQ(three.object[v * 9 + i], five.object[v * 25 + i]);
  }
}

TEST(Transfer, VerticesDoubledAlongASeamAreLitAlike) {
  Mesh mesh = sphere({0, 0, 1}, 1, 8);  // first and last column of each row coincide
  append(mesh, box({1, 1, 0}, {2, 2, 3}));
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(3, 64), {});
  for (int row = 1; row < 8; ++row) {
    for (int i = 0; i < 9; ++i) EXPECT_EQ(transfer.object[row * 17 * 9 + i], transfer.object[(row * 17 + 16) * 9 + i]);
  }
}

TEST(Transfer, AnotherSeedGivesOtherNoise) {
  Mesh mesh = box({-1, -1, 0}, {1, 1, 1});
  append(mesh, box({1.2f, -1, 0}, {2, 1, 3}));
  TransferOptions first = with(2, 64), second = first;
  second.seed = 2;
  EXPECT_FALSE(bake_transfer(mesh, kNoReceiver, first, {}).object == bake_transfer(mesh, kNoReceiver, second, {}).object);
}

TEST(Transfer, ProgressNeverFallsAndEndsAtOne) {
  const Mesh mesh = sphere({0, 0, 2}, 1, 16);
  std::vector<double> told;
  bake_transfer(mesh, {{-3, -3}, {3, 3}, 30, 30}, with(3, 64, 2), [&](double share) { told.push_back(share); });
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GE(told.front(), 0);
  EXPECT_DOUBLE_EQ(told.back(), 1);
}

// ---- odd inputs, by name ----

bool all_finite(const std::vector<glm::vec3>& values) {
  return std::all_of(values.begin(), values.end(), [](const glm::vec3& v) { return std::isfinite(v.x + v.y + v.z); });
}

TEST(TransferOf, NoTrianglesIsRefused) {
  EXPECT_THROW(bake_transfer(Mesh(), kNoReceiver, with(3, 64), {}), Error);
}

TEST(TransferOf, NonsenseOptionsAreRefused) {
  const Mesh mesh = box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(bake_transfer(mesh, kNoReceiver, with(0, 64), {}), Error);
  EXPECT_THROW(bake_transfer(mesh, kNoReceiver, with(11, 64), {}), Error);
  EXPECT_THROW(bake_transfer(mesh, kNoReceiver, with(3, 0), {}), Error);
  EXPECT_THROW(bake_transfer(mesh, kNoReceiver, with(3, 64, -1), {}), Error);
}

TEST(TransferOf, VertexInsideAnotherPartIsDark) {
  Mesh mesh = sphere({0, 0, 0}, 0.3f, 8);
  append(mesh, box({-1, -1, -1}, {1, 1, 1}));
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(3, 64, 1), {});
  EXPECT_TRUE(all_finite(transfer.object));
  for (std::size_t v = 0; v < 9 * 17; ++v) EXPECT_NEAR(under_white_sky(transfer, v), 0, 1e-5);
}

TEST(TransferOf, VerticesOnTheTableDoNotSeeItAsAnOccluder) {
  // The table's light is in the probe's lower half.
  const Mesh mesh = box({-1, -1, 0}, {1, 1, 1});
  const Transfer transfer = bake_transfer(mesh, {{-2, -2}, {2, 2}, 9, 9}, with(2, 64), {});
  for (const std::uint32_t v : used_vertices(mesh)) EXPECT_NEAR(under_white_sky(transfer, v), 1, 1e-6);
  EXPECT_TRUE(all_finite(transfer.receiver));
}

TEST(TransferOf, SmoothNormalsOnCoarseFacesDoNotShadowThemselves) {
  // Six-sided ring of flat faces with round normals: hemispheres dip below neighbouring faces only where the solid curves away.
  const Mesh mesh = sphere({0, 0, 0}, 1, 3);
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(1, 512), {});
  for (const std::uint32_t v : used_vertices(mesh)) EXPECT_NEAR(under_white_sky(transfer, v), 1, 1e-6);
}

TEST(TransferOf, NormalLeaningBelowItsFaceStaysFiniteAndInRange) {
  Mesh mesh = box({-1, -1, 0}, {1, 1, 1});
  for (Vertex& vertex : mesh.vertices) vertex.normal = glm::normalize(glm::vec3(1, 0.2f, 0.1f));
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(3, 128, 1), {});
  EXPECT_TRUE(all_finite(transfer.object));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    EXPECT_GE(under_white_sky(transfer, v), -1e-5);
    EXPECT_LE(under_white_sky(transfer, v), 1 + 1e-5);
  }
}

TEST(TransferOf, AnOpenSheetIsShadowedByItsOwnBack) {
  Mesh mesh;
  add_quad(mesh, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  add_quad(mesh, {-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1});  // faces up: its back is over the first
  const Transfer transfer = bake_transfer(mesh, kNoReceiver, with(1, 256), {});
  EXPECT_LT(under_white_sky(transfer, 0), 0.05);
  EXPECT_NEAR(under_white_sky(transfer, 4), 1, 1e-6);
}

TEST(TransferOf, AVertexThatNoTriangleUsesIsZero) {
  Mesh mesh = sphere({0, 0, 0}, 1, 8);
  mesh.vertices.push_back({{0, 0, 5}, {0, 0, 1}});
  EXPECT_EQ(bake_transfer(mesh, kNoReceiver, with(2, 16), {}).object.back(), glm::vec3(0));
}

TEST(TransferOf, TinyAndHugeScenesAreAlike) {
  Mesh mesh = box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1});
  append(mesh, box({0.7f, -0.5f, 0}, {1, 0.5f, 2}));
  const Transfer plain = bake_transfer(mesh, kNoReceiver, with(2, 1024), {});
  for (const double scale : {1e-3, 1e3}) {
    const glm::dmat4 scaled(glm::dvec4(scale, 0, 0, 0), glm::dvec4(0, scale, 0, 0), glm::dvec4(0, 0, scale, 0),
                            glm::dvec4(0, 0, 0, 1));
    const Transfer other = bake_transfer(transformed(mesh, scaled), kNoReceiver, with(2, 1024), {});
    for (std::size_t i = 0; i < plain.object.size(); ++i)
      EXPECT_NEAR(other.object[i].x, plain.object[i].x, 0.02) << scale;  // other rays
  }
}

}  // namespace
}  // namespace catchlight::render
