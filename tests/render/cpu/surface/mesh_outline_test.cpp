#include "render/cpu/surface/mesh_outline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "catchlight/projection.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/rays/ray_scene.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

constexpr int kWidth = 60, kHeight = 50;

using Pixel = std::pair<int, int>;

std::set<Pixel> crossed(const glm::dvec2& from, const glm::dvec2& to) {
  std::set<Pixel> marked;
  for_each_crossed_pixel(from, to, kWidth, kHeight, [&](int x, int y) { marked.insert({x, y}); });
  return marked;
}

TEST(CrossedPixels, AreThoseThatHoldPointsOfTheSegment) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-40, kWidth + 40), y(-40, kHeight + 40);
  for (int i = 0; i < 400; ++i) {
    const glm::dvec2 from(x(random), y(random)),
        to = i % 10 == 0 ? from + glm::dvec2(0.2, 0.1) : glm::dvec2(x(random), y(random));
    const std::set<Pixel> marked = crossed(from, to);
    for (int k = 0; k <= 5000; ++k) {
      const glm::dvec2 p = glm::mix(from, to, k / 5000.0) + 0.5, rest = glm::abs(p - glm::round(p));
      if (p.x < 0 || p.y < 0 || p.x >= kWidth || p.y >= kHeight || std::min(rest.x, rest.y) < 1e-9) continue;
      ASSERT_TRUE(marked.contains({static_cast<int>(p.x), static_cast<int>(p.y)})) << p.x << ", " << p.y;
    }
    const glm::dvec2 along = to - from;
    for (const auto& [px, py] : marked) {
      ASSERT_TRUE(px >= 0 && py >= 0 && px < kWidth && py < kHeight);
      const double share = std::clamp(glm::dot(glm::dvec2(px, py) - from, along) / glm::dot(along, along), 0.0, 1.0);
      EXPECT_LT(glm::distance(from + share * along, glm::dvec2(px, py)), 0.7072) << "no pixel that the segment passes by";
    }
  }
}

TEST(CrossedPixels, OfSegmentsAlongBordersAndWithoutLength) {
  EXPECT_EQ(crossed({3, 4}, {3, 4}), (std::set<Pixel>{{3, 4}}));
  EXPECT_EQ(crossed({3, 4}, {6, 4}).size(), 4u);
  EXPECT_EQ(crossed({3, 6}, {3, 4}).size(), 3u);
  EXPECT_TRUE(crossed({-5, 4}, {-2, 40}).empty());
  EXPECT_FALSE(crossed({2.5, 3}, {2.5, 9}).empty()) << "between two columns";
  EXPECT_EQ(crossed({-1e9, 10}, {1e9, 10}).size(), std::size_t{kWidth});
}

Mesh icosahedron(const glm::vec3& middle, float radius) {
  Mesh mesh;
  mesh.materials.push_back(white());
  const float g = 1.6180339887f;
  for (const glm::vec3& p : {glm::vec3(-1, g, 0),
                             {1, g, 0},
                             {-1, -g, 0},
                             {1, -g, 0},
                             {0, -1, g},
                             {0, 1, g},
                             {0, -1, -g},
                             {0, 1, -g},
                             {g, 0, -1},
                             {g, 0, 1},
                             {-g, 0, -1},
                             {-g, 0, 1}})
    mesh.vertices.push_back({middle + radius * glm::normalize(p), glm::normalize(p)});
  for (const auto& [a, b, c] :
       {std::tuple(0, 11, 5), {0, 5, 1},  {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2},
        {10, 7, 6},           {7, 1, 8},  {3, 9, 4}, {3, 4, 2},  {3, 2, 6},   {3, 6, 8}, {3, 8, 9},  {4, 9, 5},
        {2, 4, 11},           {6, 2, 10}, {8, 6, 7}, {9, 8, 1}})
    add_triangle(mesh, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c));
  return mesh;
}

/// A camera that looks along the tag's x, y diagonal from above; whose frame is the mesh's.
struct View {
  CameraModel camera{.width_px = kWidth, .height_px = kHeight, .fx_px = 70, .fy_px = 70, .cx_px = 29.5, .cy_px = 24.5};
  RigidTransform camera_from_tag;
  glm::vec3 eye_m;

  explicit View(const glm::dvec3& eye) : eye_m(eye) {
    const glm::dvec3 z = glm::normalize(-eye), x = glm::normalize(glm::cross(z, glm::dvec3(0, 0, 1))), y = glm::cross(z, x);
    camera_from_tag.rotation = glm::transpose(glm::dmat3(x, y, z));
    camera_from_tag.translation_m = -(camera_from_tag.rotation * eye);
  }

  glm::vec3 direction(double px, double py) const {
    const glm::dvec3 ray((px - camera.cx_px) / camera.fx_px, (py - camera.cy_px) / camera.fy_px, 1);
    return glm::vec3(glm::transpose(camera_from_tag.rotation) * ray);
  }
};

std::set<Pixel> outline_of(const Mesh& mesh, const View& view) {
  std::set<Pixel> marked;
  MeshOutline(mesh).for_each_seen(view.eye_m, [&](const glm::vec3& from, const glm::vec3& to) {
    const auto a = project_px(view.camera, view.camera_from_tag * glm::dvec3(from)),
               b = project_px(view.camera, view.camera_from_tag * glm::dvec3(to));
    for_each_crossed_pixel(a.value(), b.value(), kWidth, kHeight, [&](int x, int y) { marked.insert({x, y}); });
  });
  return marked;
}

/// Pixels in which 12 x 12 rays do not all see the same side: a box's faces are sides, a smooth surface has but one.
std::set<Pixel> mixed_pixels(const Mesh& mesh, const View& view, bool is_smooth) {
  const RayScene scene(mesh);
  std::set<Pixel> mixed;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      std::set<std::uint32_t> seen;
      for (int i = 0; i < 144; ++i) {
        const auto hit = scene.closest_hit(view.eye_m, view.direction(x + (i % 12 - 5.5) / 12, y + (i / 12 - 5.5) / 12));
        seen.insert(!hit ? 0xffffu : is_smooth ? 0u : hit->triangle / 2);
      }
      if (seen.size() > 1) mixed.insert({x, y});
    }
  return mixed;
}

void expect_all_marked(const Mesh& mesh, bool is_smooth) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 12; ++i) {
    const View view(0.4 * glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))));
    const std::set<Pixel> marked = outline_of(mesh, view), mixed = mixed_pixels(mesh, view, is_smooth);
    EXPECT_GT(mixed.size(), 30u);
    for (const Pixel& pixel : mixed) EXPECT_TRUE(marked.contains(pixel)) << pixel.first << ", " << pixel.second;
    // Edges behind the object are marked too, and pixels that an edge grazes.
    EXPECT_LT(marked.size(), 3 * mixed.size());
  }
}

TEST(MeshOutline, OfASmoothSolidMarksWherePixelsAreCoveredInPart) {
  expect_all_marked(icosahedron({0.01f, 0, 0}, 0.1f), true);
}

TEST(MeshOutline, OfABoxMarksItsCreasesToo) {
  expect_all_marked(box({-0.08f, -0.05f, -0.06f}, {0.07f, 0.06f, 0.05f}), false);
}

TEST(MeshOutline, OfAnOpenSurfaceIsItsRim) {
  int rim = 0;
  MeshOutline(disc({0, 0, 0}, 1, 16)).for_each_seen({0.2f, 0.1f, -3}, [&](const glm::vec3& a, const glm::vec3& b) {
    EXPECT_NEAR(glm::length(a), 1, 1e-5);
    EXPECT_NEAR(glm::length(b), 1, 1e-5);
    ++rim;
  });
  EXPECT_EQ(rim, 16);
}

TEST(MeshOutline, SeesNoEdgeInAFlatSurfaceWhateverItsVerticesNumbers) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  add_quad(mesh, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0});  // vertices of its own along x = 1
  int edges = 0;
  MeshOutline(mesh).for_each_seen({0.5f, 0.5f, 2}, [&](const glm::vec3& a, const glm::vec3& b) {
    EXPECT_FALSE(a.x == 1 && b.x == 1);
    ++edges;
  });
  EXPECT_EQ(edges, 6) << "the rim";
}

TEST(MeshOutline, OfDegenerateTrianglesIsHarmless) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  add_triangle(mesh, 0, 0, 1);
  add_triangle(mesh, 2, 2, 2);
  add_triangle(mesh, 0, 1, 0);
  int edges = 0;
  MeshOutline(mesh).for_each_seen({0.5f, 0.5f, 2}, [&](const glm::vec3&, const glm::vec3&) { ++edges; });
  EXPECT_GE(edges, 4);
  MeshOutline(Mesh{}).for_each_seen({0, 0, 1}, [&](const glm::vec3&, const glm::vec3&) { FAIL(); });
}

}  // namespace
}  // namespace catchlight::render
