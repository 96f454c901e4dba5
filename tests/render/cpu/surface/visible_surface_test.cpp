#include "render/cpu/surface/visible_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <numeric>
#include <random>

#include "catchlight/projection.hpp"
#include "render/rays/ray_scene.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

/// 160 x 120 pixels, looking straight down at the tag's plane from 0.5 m.
FrameView view_from_above(double height_m = 0.5) {
  FrameView view;
  view.camera = {.width_px = 160, .height_px = 120, .fx_px = 200, .fy_px = 200, .cx_px = 79.5, .cy_px = 59.5};
  view.camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  view.camera_from_tag.translation_m = {0, 0, height_m};
  return view;
}

VisibleSurface seen(const Mesh& mesh, const FrameView& view, int samples = 4) {
  const RayScene rays(mesh);
  const DistortionLimit limit = distortion_limit(view.camera);
  PixelRays pixel_rays;
  pixel_rays.set_camera(view.camera, limit);
  const std::vector<glm::vec3> irradiance_over_pi(mesh.vertices.size(), glm::vec3(1, 2, 3));
  SurfaceFinder finder(mesh, rays, samples, std::vector<char>(mesh.materials.size(), 0));
  return finder.find(view, limit, pixel_rays, {0, 0, view.camera.width_px, view.camera.height_px}, irradiance_over_pi);
}

double area_px(const VisibleSurface& surface) {
  return std::accumulate(surface.points.begin(), surface.points.end(), 0.0,
                         [](double sum, const SurfacePoint& point) { return sum + point.coverage; });
}

TEST(VisibleSurface, CoversATriangleByItsArea) {
  // Pixels per metre are 400.
  Mesh mesh;
  mesh.materials.push_back(white());
  for (const glm::vec3& p : {glm::vec3(-0.12f, -0.1f, 0), {0.13f, -0.07f, 0}, {0.02f, 0.11f, 0}})
    mesh.vertices.push_back({p, {0, 0, 1}});
  add_triangle(mesh, 0, 1, 2);
  const double area = 0.5 * (0.25 * 0.21 - 0.14 * 0.03) * 400 * 400;
  for (const int samples : {1, 2, 4, 8, 16})
    EXPECT_NEAR(area_px(seen(mesh, view_from_above(), samples)), area, 0.01 * area) << samples;
}

TEST(VisibleSurface, CoversASphereByItsOutline) {
  // Seen from afar off the axis a sphere is an ellipse: the cone of half angle a around the direction at t to the axis, cut by
  // the picture's plane.
  const Mesh mesh = sphere({0.08f, 0.05f, 0}, 0.06f, 96);
  const double distance = std::sqrt(0.08 * 0.08 + 0.05 * 0.05 + 0.25), a = std::asin(0.06 / distance),
               t = std::acos(0.5 / distance);
  const double low = std::tan(t - a), high = std::tan(t + a), half_long = (high - low) / 2;
  // Half the shorter axis follows from the ellipse's excentricity, sin t / cos a.
  const double minor = half_long * std::sqrt(1 - std::pow(std::sin(t) / std::cos(a), 2));
  const double area = std::numbers::pi * half_long * minor * 200 * 200;
  EXPECT_NEAR(area_px(seen(mesh, view_from_above(), 16)), area, 0.005 * area);
  EXPECT_NEAR(area_px(seen(mesh, view_from_above(), 4)), area, 0.01 * area);
  EXPECT_NEAR(area_px(seen(mesh, view_from_above(), 1)), area, 0.03 * area);
}

TEST(VisibleSurface, KnowsWhatAPixelShows) {
  const Mesh mesh = sphere({0, 0, 0}, 0.1f, 64);
  const VisibleSurface surface = seen(mesh, view_from_above());
  for (std::size_t pixel = 0; pixel < surface.first.size(); ++pixel) {
    if (surface.first[pixel] < 0) continue;
    double coverage = 0;
    for (auto i = static_cast<std::size_t>(surface.first[pixel]); i < surface.points.size() && surface.points[i].pixel == pixel;
         ++i) {
      const SurfacePoint& point = surface.points[i];
      coverage += point.coverage;
      EXPECT_NEAR(glm::length(point.position_m), 0.1, 5e-4);
      EXPECT_NEAR(point.depth_m, 0.5 - point.position_m.z, 1e-5);
      EXPECT_NEAR(glm::length(point.normal), 1, 1e-5);
      EXPECT_GE(glm::dot(point.normal, point.to_viewer), -1e-5f);
      EXPECT_LT(glm::distance(point.to_viewer, glm::normalize(glm::vec3(0, 0, 0.5f) - point.position_m)), 1e-5f);
      EXPECT_LT(glm::distance(point.irradiance_over_pi, glm::vec3(1, 2, 3)), 1e-5f);
      EXPECT_FALSE(point.is_back);
      if (point.coverage == 1) {
        EXPECT_GT(glm::dot(point.normal, glm::normalize(point.position_m)), 0.998f);
      }
    }
    EXPECT_LE(coverage, 1 + 1e-6);
  }
}

TEST(VisibleSurface, OneSampleIsAllOrNothing) {
  for (const SurfacePoint& point : seen(box(glm::vec3(-0.05f), glm::vec3(0.05f)), view_from_above(), 1).points)
    EXPECT_EQ(point.coverage, 1);
}

TEST(VisibleSurface, APixelOnACreaseShowsBothSides) {
  // A roof, its ridge along a column of pixels' middles.
  Mesh mesh;
  add_quad(mesh, {-0.1f, -0.1f, -0.1f}, {0.00125f, -0.1f, 0}, {0.00125f, 0.1f, 0}, {-0.1f, 0.1f, -0.1f});
  add_quad(mesh, {0.00125f, -0.1f, 0}, {0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, -0.1f}, {0.00125f, 0.1f, 0});
  const VisibleSurface surface = seen(mesh, view_from_above());
  const std::size_t ridge = 60 * 160 + 80;
  const auto first = static_cast<std::size_t>(surface.first[ridge]);
  ASSERT_EQ(surface.points[first].pixel, ridge);
  ASSERT_EQ(surface.points[first + 1].pixel, ridge);
  EXPECT_EQ(surface.points[first].coverage, 0.5f);
  EXPECT_EQ(surface.points[first + 1].coverage, 0.5f);
  EXPECT_LT(surface.points[first].normal.x * surface.points[first + 1].normal.x, 0);
}

TEST(VisibleSurface, ALongEdgeThroughAStrongLensIsSmoothAllAlong) {
  // The edge runs aslant across the picture, bent by the lens: wherever it goes, some pixels along it are covered in part. Its
  // pieces are straight in the picture, so that they must be as short as scenes have them, a 24th of the diagonal.
  FrameView view = view_from_above();
  view.camera.distortion = {-0.5, 0.25, 0, 0, 0, 0, 0, 0};
  Mesh mesh;
  add_quad(mesh, {-0.6f, -0.6f, 0}, {0.6f, -0.6f, 0}, {0.6f, 0.12f, 0}, {-0.6f, 0.08f, 0});
  subdivide_long_edges(mesh, 1.7 / 24, 100000);
  const VisibleSurface surface = seen(mesh, view);
  int longest = 0, run = 0;
  for (int x = 0; x < 160; ++x) {
    bool partial = false;
    for (int y = 0; y < 120; ++y) {
      const std::int32_t first = surface.first[static_cast<std::size_t>(y) * 160 + x];
      partial = partial || (first >= 0 && surface.points[static_cast<std::size_t>(first)].coverage < 1);
    }
    run = partial ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  EXPECT_LT(longest, 16) << "columns without a smooth edge";
}

TEST(VisibleSurface, ACameraWithinTheObjectSeesItsBackEverywhere) {
  const VisibleSurface surface = seen(sphere({0, 0, 0.5f}, 0.3f, 32), view_from_above());
  EXPECT_NEAR(area_px(surface), 160 * 120, 1e-3);
  for (const SurfacePoint& point : surface.points) {
    EXPECT_TRUE(point.is_back);
    EXPECT_GE(glm::dot(point.normal, point.to_viewer), 0) << "towards the viewer";
  }
}

TEST(VisibleSurface, AnObjectLargerThanTheFrameFillsIt) {
  Mesh mesh;
  add_quad(mesh, {-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  EXPECT_EQ(area_px(seen(mesh, view_from_above())), 160 * 120);
  // A plane that goes on beyond the camera: edges are cut where they pass it.
  for (Vertex& vertex : mesh.vertices) vertex.position_m.z = 0.2f + 0.8f * vertex.position_m.y;
  EXPECT_GT(area_px(seen(mesh, view_from_above())), 0);
}

TEST(VisibleSurface, OfALensThatSeesNothingInPlacesIsWhatTheRestSees) {
  // Rays that are no numbers would end the program.
  const Mesh mesh = sphere({0, 0, 0}, 0.12f, 24);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> radial(-1.5, 1.5), tangential(-0.1, 0.1);
  for (int i = 0; i < 40; ++i) {
    FrameView view = view_from_above();
    view.camera.distortion = {radial(random), radial(random), tangential(random), tangential(random),
                              radial(random), radial(random), radial(random),     radial(random)};
    for (const SurfacePoint& point : seen(mesh, view).points) EXPECT_NEAR(glm::length(point.position_m), 0.12, 2e-3);
  }
}

TEST(VisibleSurface, MissesNoPixelThatARayFindsTheObjectIn) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-0.2f, 0.2f), length(0.001f, 0.15f), angle(-0.5f, 0.5f);
  std::size_t hits = 0;
  for (int i = 0; i < 150; ++i) {
    Mesh mesh;
    mesh.materials.push_back(white());
    const float largest = length(random);
    for (std::uint32_t k = 0; k < 60; ++k) {
      const glm::vec3 middle(place(random), place(random), place(random));
      for (int corner = 0; corner < 3; ++corner)
        mesh.vertices.push_back({middle + largest * 5 * glm::vec3(place(random), place(random), place(random)), {0, 0, 1}});
      add_triangle(mesh, 3 * k, 3 * k + 1, 3 * k + 2);
    }
    FrameView view = view_from_above(0.1 + 3 * std::abs(place(random)));  // within the mesh, close by, and from afar
    view.camera_from_tag.rotation = glm::dmat3(glm::rotate(glm::mat4(1), angle(random), {1, 0, 0})) *
                                    glm::dmat3(glm::rotate(glm::mat4(1), angle(random), {0, 1, 0})) *
                                    view.camera_from_tag.rotation;
    if (i % 5 == 0) view.camera.distortion = {-0.3, 0.1, 0.002, -0.001, 0, 0, 0, 0};
    const VisibleSurface surface = seen(mesh, view, 1);
    const RayScene rays(mesh);
    PixelRays pixel_rays;
    pixel_rays.set_camera(view.camera, distortion_limit(view.camera));
    const glm::vec3 eye_m(inverse(view.camera_from_tag).translation_m);
    const glm::mat3 tag_from_camera(glm::transpose(view.camera_from_tag.rotation));
    for (std::size_t pixel = 0; pixel < surface.first.size(); ++pixel) {
      const glm::vec2 normalized = pixel_rays.at(static_cast<int>(pixel % 160), static_cast<int>(pixel / 160));
      const glm::vec3 direction = tag_from_camera * glm::vec3(normalized, 1);
      const bool is_hit = rays.closest_hit(eye_m + 0.001f * direction, direction).has_value();
      hits += is_hit;
      if (is_hit) {
        ASSERT_GE(surface.first[pixel], 0) << "mesh " << i << ", pixel " << pixel;
      }
    }
  }
  EXPECT_GT(hits, 100000u);
}

TEST(VisibleSurface, HasANormalWhateverTheVerticesSay) {
  for (const glm::vec3& normal : {glm::vec3(0), {0, 0, -1}, {1e-30f, 0, 0}, {0, 3, 0}}) {
    Mesh mesh;
    add_quad(mesh, {-0.1f, -0.1f, 0}, {0.1f, -0.1f, 0}, {0.1f, 0.1f, 0}, {-0.1f, 0.1f, 0});
    for (Vertex& vertex : mesh.vertices) vertex.normal = normal;
    // The middle of the picture looks straight down, so that there the second lies straight along the ray.
    FrameView view = view_from_above();
    view.camera.cx_px = 80, view.camera.cy_px = 60;
    for (const SurfacePoint& point : seen(mesh, view).points) {
      EXPECT_NEAR(glm::length(point.normal), 1, 1e-5);
      EXPECT_GE(glm::dot(point.normal, point.to_viewer), -1e-5f);
    }
  }
}

TEST(VisibleSurface, WithoutAnythingToSeeIsEmpty) {
  Mesh flat;
  flat.materials.push_back(white());
  for (int i = 0; i < 3; ++i) flat.vertices.push_back({{0.01f * static_cast<float>(i), 0, 0}, {0, 0, 1}});
  add_triangle(flat, 0, 1, 2);
  add_triangle(flat, 1, 1, 1);
  EXPECT_TRUE(seen(flat, view_from_above()).points.empty()) << "triangles without area";
  EXPECT_TRUE(seen(Mesh{}, view_from_above()).points.empty());
  EXPECT_TRUE(seen(sphere({0, 0, 3}, 0.1f, 8), view_from_above()).points.empty()) << "behind the camera";
}

}  // namespace
}  // namespace catchlight::render
