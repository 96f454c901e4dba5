// What the transfer makes of the surface that the object stands on, and of parts that go through each other.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catchlight/image.hpp"
#include "render/transfer/interior_vertices.hpp"
#include "render/transfer/receiver_albedo.hpp"
#include "render/transfer/transfer.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

TransferOptions on_a_table(const glm::vec3& albedo, int bands = 1, int bounces = 1) {
  TransferOptions options;
  options.bands = bands, options.rays = 1024, options.bounces = bounces;
  options.receiver_albedo = constant_albedo(albedo);
  return options;
}

/// Irradiance / pi at vertex v under a sky (and a table as bright) of radiance 1.
double under_white_sky(const Transfer& transfer, std::size_t v) {
  return transfer.object[v * sh_count(transfer.bands)].x * 2 * std::sqrt(kPi);
}

std::size_t lowest_vertex(const Mesh& mesh) {
  std::size_t lowest = 0;
  for (std::size_t v = 1; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v].position_m.z < mesh.vertices[lowest].position_m.z) lowest = v;
  return lowest;
}

TEST(OnATable, TheUndersideIsDarkenedByTheShadowBelowIt) {
  // A ball's lowest point at height h over its own shadow: the open share there is 1 less the ball's form factor.
  Mesh mesh = sphere({0, 0, 0.15f}, 0.1f, 40);
  mesh.materials[0].base_color = glm::vec3(0.5f);
  const Transfer transfer = bake_transfer(mesh, receiver_grid_for(mesh, 96), on_a_table(glm::vec3(1)), {});
  const std::size_t bottom = lowest_vertex(mesh);
  // Brute force: rays from 0.05 over the table see points at distance r from the axis, of which 1 - F(r) is open.
  double open = 0;
  for (int i = 0; i < 4000; ++i) {
    const double sin2 = (i + 0.5) / 4000, r = 0.05 * std::sqrt(sin2 / (1 - sin2)), d2 = r * r + 0.15 * 0.15;
    open += (1 - 0.1 * 0.1 / d2 * 0.15 / std::sqrt(d2)) / 4000;
  }
  // The table is lit by the ball's own underside as well: half of what it loses, once more, at most.
  EXPECT_NEAR(under_white_sky(transfer, bottom), open, 0.04);
  const Transfer without = bake_transfer(mesh, receiver_grid_for(mesh, 96), {.bands = 1, .rays = 1024, .bounces = 1}, {});
  EXPECT_NEAR(under_white_sky(without, bottom), 1, 1e-5) << "an unknown table is as open as the sky";
}

TEST(OnATable, ABlackTableHasNothingToLose) {
  const Mesh mesh = sphere({0, 0, 0.15f}, 0.1f, 20);
  const Transfer black = bake_transfer(mesh, receiver_grid_for(mesh, 48), on_a_table(glm::vec3(0)), {});
  for (const std::uint32_t v : used_vertices(mesh)) EXPECT_NEAR(under_white_sky(black, v), 1, 1e-5);
}

TEST(OnATable, TheTopDoesNotSeeIt) {
  const Mesh mesh = box({-0.1f, -0.1f, 0}, {0.1f, 0.1f, 0.1f});
  const Transfer transfer = bake_transfer(mesh, receiver_grid_for(mesh, 48), on_a_table(glm::vec3(0.8f), 1, 4), {});
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v].normal.z > 0.9f) {
      EXPECT_NEAR(under_white_sky(transfer, v), 1, 1e-5);
    }
}

TEST(OnATable, IsSeenWhereItIsNotWhereTheProbeSawIt) {
  // A table white for x > 0 and black for x < 0, seen by a probe above the border, in a white sky. A speck 0.3 m to the right
  // that faces down sees much more white than the probe did.
  Probe probe{Image(512, 256)};
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 512; ++x) {
      const glm::dvec3 d = *direction_from_texel(probe.layout, 512, 256, x, y);  // probe +y up, +x = tag +x
      const float radiance = d.y >= 0 || d.x > 0 ? 1.0f : 0.0f;
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = radiance;
    }
  }
  const glm::dmat3 rotation = tag_from_probe(UpAxis::z, 0);
  const auto albedo = albedo_from_probe(probe, rotation, {0, 0, 0.1f});
  ASSERT_TRUE(albedo);
  Mesh speck;
  add_quad(speck, {0.299f, -1e-3f, 0.1f}, {0.299f, 1e-3f, 0.1f}, {0.301f, 1e-3f, 0.1f}, {0.301f, -1e-3f, 0.1f});
  ASSERT_LT(speck.vertices[0].normal.z, -0.9f);
  TransferOptions options;
  options.bands = 8, options.rays = 4096, options.bounces = 1, options.receiver_albedo = *albedo;
  const Transfer transfer = bake_transfer(speck, receiver_grid_for(speck, 16), options, {});
  const ShRgb light = rotate_sh(project_to_sh(probe, options.bands), rotation);
  double exit = 0;
  for (int i = 0; i < sh_count(options.bands); ++i) exit += transfer.object[i].x * light[i].x;
  // Closed form: cosine-weighted, the half space x > -0.3 seen from 0.1 above a plane is 1/2 + sin(atan(0.3 / 0.1)) / 2.
  EXPECT_NEAR(exit, 0.5 + 0.5 * std::sin(std::atan(3.0)), 0.02) << "1/2 as the probe saw it";
}

TEST(OnATable, ASunkObjectIsLitAtTheTableAsIfItStoodThere) {
  // Vertices below the table are never seen, but the triangles between them and those above are.
  const Mesh mesh = sphere({0, 0, 0.02f}, 0.1f, 40);
  const Transfer transfer = bake_transfer(mesh, receiver_grid_for(mesh, 64), on_a_table(glm::vec3(0.8f)), {});
  for (const std::uint32_t v : used_vertices(mesh)) {
    const float z = mesh.vertices[v].position_m.z;
    if (std::abs(z) < 0.01f) {
      EXPECT_GT(under_white_sky(transfer, v), 0.5) << z;
    }
    EXPECT_TRUE(std::isfinite(under_white_sky(transfer, v)));
  }
}

TEST(OnATable, AFloatingObjectHardlyKnowsIt) {
  const Mesh mesh = sphere({0, 0, 1}, 0.05f, 20);
  const Transfer transfer = bake_transfer(mesh, receiver_grid_for(mesh, 64), on_a_table(glm::vec3(1)), {});
  for (const std::uint32_t v : used_vertices(mesh)) EXPECT_NEAR(under_white_sky(transfer, v), 1, 0.01);
}

TEST(OnATable, BouncesEndWhereTheyStopMattering) {
  Mesh mesh = sphere({0, 0, 0.1f}, 0.1f, 12);
  mesh.materials[0].base_color = glm::vec3(0.02f);
  const auto with = [&](int bounces) {
    return bake_transfer(mesh, receiver_grid_for(mesh, 16), on_a_table(glm::vec3(0.1f), 2, bounces), {});
  };
  EXPECT_TRUE(with(4).object == with(16).object) << "what is left of the light after four is nothing to see";
}

// ---- what the probe knows of the table ----

Probe half_and_half(float above, float below) {
  Probe probe{Image(128, 64)};
  for (int y = 0; y < 64; ++y)
    for (int i = 0; i < 3 * 128; ++i) probe.image.pixel(0, y)[i] = y < 32 ? above : below;
  return probe;
}

TEST(ReceiverAlbedo, IsPiLOverE) {
  for (const float scale : {1.0f, 1000.0f, 1e-4f}) {
    const auto albedo = albedo_from_probe(half_and_half(2 * scale, 0.6f * scale), tag_from_probe(UpAxis::z, 0), {0, 0, 0.1f});
    ASSERT_TRUE(albedo);
    EXPECT_NEAR(albedo->towards({0.3f, 0.2f, -1}).g, 0.3, 2e-3) << scale;
  }
}

TEST(ReceiverAlbedo, LooksAtAPointFromWhereTheProbeWas) {
  const auto albedo = albedo_from_probe(half_and_half(2, 0.6f), tag_from_probe(UpAxis::z, 0), {0.5f, 0, 0.1f});
  EXPECT_EQ(albedo->at({0.9f, 0.3f}), albedo->towards({0.4f, 0.3f, -0.1f}));
}

TEST(ReceiverAlbedo, IsUnknownWhereThePlaneShinesOrIsDark) {
  EXPECT_FALSE(albedo_from_probe(half_and_half(1, 3), tag_from_probe(UpAxis::z, 0), {0, 0, 0.1f})) << "light from below";
  EXPECT_FALSE(albedo_from_probe(half_and_half(0, 1), tag_from_probe(UpAxis::z, 0), {0, 0, 0.1f})) << "only from below";
  EXPECT_FALSE(albedo_from_probe(half_and_half(1, 1), tag_from_probe(UpAxis::z, 0), {0, 0, 0})) << "the probe lies on the plane";
  const auto black = albedo_from_probe(half_and_half(0, 0), tag_from_probe(UpAxis::z, 0), {0, 0, 0.1f});
  ASSERT_TRUE(black);
  EXPECT_EQ(black->towards({0, 0, -1}), glm::vec3(0));
}

TEST(ReceiverAlbedo, OfALampBelowTheHorizonIsOneAtMost) {
  Probe probe = half_and_half(1, 0.2f);
  for (int c = 0; c < 3; ++c) probe.image.pixel(10, 34)[c] = 500;
  const auto albedo = albedo_from_probe(probe, tag_from_probe(UpAxis::z, 0), {0, 0, 0.1f});
  ASSERT_TRUE(albedo);
  for (const float value : albedo->image.data) EXPECT_LE(value, 1);
}

// ---- parts that go through each other ----

TEST(InteriorVertices, TakeTheMeanOfTheirOpenNeighbours) {
  Mesh mesh;  // a fan of four around vertex 0, and one triangle that nobody sees
  mesh.materials.push_back(white());
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back({glm::vec3(i, i * i, 0), {0, 0, 1}});
  for (std::uint32_t i = 1; i < 5; ++i) add_triangle(mesh, 0, i, i % 4 + 1);
  add_triangle(mesh, 5, 6, 7);
  const InteriorVertices interior(mesh, {1, 0, 0, 0, 1, 1, 1, 1});
  std::vector<glm::vec3> values;
  for (int v = 0; v < 8; ++v) values.insert(values.end(), {glm::vec3(v), glm::vec3(10.0f * v)});
  interior.fill(values);
  EXPECT_EQ(values[0], glm::vec3(2)) << "of 1, 2 and 3; 4 is interior as well";
  EXPECT_EQ(values[1], glm::vec3(20));
  EXPECT_EQ(values[8], glm::vec3(2)) << "of 1 and 3";
  EXPECT_EQ(values[2], glm::vec3(1)) << "an open one keeps its own";
  EXPECT_EQ(values[12], glm::vec3(6)) << "no open neighbour: not seen";
}

TEST(InteriorVertices, DoNotDarkenWhatSticksOut) {
  // A pyramid's tip sticks out of a box; its base lies within.
  Mesh mesh = box({-1, -1, -1}, {1, 1, 1});
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
  const glm::vec3 corners[] = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0, 0.5f, 0}};
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 a = corners[i], b = corners[(i + 1) % 3], top(0, 0, 2);
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, top - a));
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec3& p : {a, b, top}) mesh.vertices.push_back({p, normal});
    add_triangle(mesh, base, base + 1, base + 2);
  }
  const Transfer transfer = bake_transfer(mesh, {}, {.bands = 1, .rays = 512, .bounces = 0}, {});
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(under_white_sky(transfer, tip + 3 * i + 2), 0.6);
    EXPECT_NEAR(under_white_sky(transfer, tip + 3 * i), under_white_sky(transfer, tip + 3 * i + 2), 1e-6)
        << "not the dark within";
  }
}

// ---- the grid ----

TEST(ReceiverGridFor, CoversTheFootprintAndTwiceTheHeightWithSquareCells) {
  const ReceiverGrid grid = receiver_grid_for(box({-1, 0, 0}, {2, 1, 0.5f}), 41);
  EXPECT_FLOAT_EQ(grid.min_m.x, -2);
  EXPECT_FLOAT_EQ(grid.min_m.y, -1);
  EXPECT_NEAR(grid.max_m.x, 3, 1e-5);
  EXPECT_GE(grid.max_m.y, 2 - 1e-5);
  EXPECT_EQ(grid.columns, 41);
  EXPECT_NEAR((grid.max_m.x - grid.min_m.x) / (grid.columns - 1), (grid.max_m.y - grid.min_m.y) / (grid.rows - 1), 1e-6);
}

TEST(ReceiverGridFor, AnObjectBelowTheTableIsEmpty) {
  EXPECT_EQ(receiver_grid_for(box({0, 0, -2}, {1, 1, -1}), 41).columns, 0);
}

}  // namespace
}  // namespace catchlight::render
