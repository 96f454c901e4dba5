// Metal that mirrors metal: closed forms of mirrors that face each other, and both renderers against each other in caves.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "render/cpu/cpu_compositor.hpp"
#include "render/gl_compositor.hpp"
#include "render/rays/skip_bvh.hpp"
#include "tests/support/gl_fixture.hpp"

namespace catchlight::render::test {
namespace {

class MetalGl : public GlTest {};

Material metal(const glm::vec3& color, float roughness) {
  Material material;
  material.base_color = color;
  material.metallic = 1;
  material.roughness = roughness;
  return material;
}

/// Two mirrors that meet below the tag's origin in a line along y, `angle` apart, and open towards +z.
Mesh groove(double angle) {
  Mesh mesh;
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 up(side * std::sin(angle / 2), 0, std::cos(angle / 2)),
        normal(-side * std::cos(angle / 2), 0, std::sin(angle / 2));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const double y : {-0.1, 0.1})
      for (const double length : {0.0, 0.1})
        mesh.vertices.push_back({glm::vec3(length * up + glm::dvec3(0, y, -0.05)), glm::vec3(normal), glm::vec3(1)});
    const std::uint32_t a = first, b = first + 1, c = first + 2, d = first + 3;
    if (side > 0)
      mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    else
      mesh.indices.insert(mesh.indices.end(), {a, d, b, a, c, d});
  }
  mesh.triangle_material.assign(4, 0);
  return mesh;
}

TEST_F(MetalGl, AGrooveReddensByEachOfItsMirrors) {
  // A ray that enters along the middle of two mirrors at an angle of pi / n leaves after n reflections; it meets them at angles
  // that unfolding gives.
  const glm::dvec3 color(0.9, 0.5, 0.3);
  for (const int reflections : {2, 3, 4}) {
    const double angle = std::numbers::pi / reflections;
    glm::dvec3 expected(1);
    for (int i = 0; i < reflections; ++i) {
      const double cosine = std::abs(std::sin((i + 0.5) * angle));
      expected *= color + (1.0 - color) * std::pow(1 - cosine, 5);
    }
    GlCompositor compositor(constant_scene(groove(angle), metal(color, 0), glm::vec3(1)), without_glare());
    const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
    for (const int x : {75, 78, 82, 84}) {
      const glm::vec4 pixel = pixel_at(composite, x, 60);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(pixel[c], expected[c], 0.01) << reflections << " reflections, pixel " << x << ", channel " << c;
    }
  }
}

TEST_F(MetalGl, OnlyWhatHasSomethingAboveItMeetsTheObject) {
  // A ball under a square: the planes through its surface that pass below one of the square's corners.
  Mesh mesh = sphere(0.03, {0, 0, 0.05}, 24);
  const SkipBvh of_ball = build_skip_bvh(mesh);
  for (const Vertex& vertex : mesh.vertices)
    EXPECT_FALSE(reaches_above(of_ball, mesh, vertex.position_m, vertex.normal, 1e-6f)) << "a ball mirrors nothing of itself";
  const std::size_t of_ball_alone = mesh.vertices.size();
  append(mesh, square({-0.03, -0.03}, {0.03, 0.03}, 0.1));
  const SkipBvh of_both = build_skip_bvh(mesh);
  for (std::size_t v = 0; v < of_ball_alone; ++v) {
    const glm::vec3 p = mesh.vertices[v].position_m, n = mesh.vertices[v].normal;
    bool above = false;
    for (const float x : {-0.03f, 0.03f})
      for (const float y : {-0.03f, 0.03f}) above = above || glm::dot(glm::vec3(x, y, 0.1f) - p, n) > 1e-6f;
    EXPECT_EQ(reaches_above(of_both, mesh, p, n, 1e-6f), above);
  }
}

/// A tube along a knot on a torus, whose turns mirror one another.
Mesh knot() {
  constexpr int kAlong = 360, kAround = 24;
  constexpr double kTube_m = 0.016;
  const auto middle = [](double t) {
    const double radius = 0.045 + 0.022 * std::cos(3 * t);
    return glm::dvec3(radius * std::cos(2 * t), radius * std::sin(2 * t), 0.06 + 0.03 * std::sin(3 * t));
  };
  Mesh mesh;
  for (int i = 0; i <= kAlong; ++i) {
    const double t = 2 * std::numbers::pi * i / kAlong;
    const glm::dvec3 p = middle(t), along = glm::normalize(middle(t + 1e-4) - middle(t - 1e-4));
    const glm::dvec3 x = glm::normalize(glm::cross(along, p - glm::dvec3(0, 0, 0.06))), y = glm::cross(along, x);
    for (int k = 0; k <= kAround; ++k) {
      const double phi = 2 * std::numbers::pi * k / kAround;
      const glm::dvec3 n = std::cos(phi) * x + std::sin(phi) * y;
      mesh.vertices.push_back({glm::vec3(p + kTube_m * n), glm::vec3(n), glm::vec3(1)});
    }
  }
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAround; ++k) {
      const auto a = static_cast<std::uint32_t>(i * (kAround + 1) + k), b = a + kAround + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b + 1, b, a, a + 1, b + 1});
    }
  }
  mesh.triangle_material.assign(mesh.indices.size() / 3, 0);
  return mesh;
}

struct Difference {
  double mean, percentile99;  ///< of 255, over the frame
};

/// The difference of means over 7 x 7 pixels: the processor's renderer spreads a lobe's rays over neighbours, whose sums are
/// noisy one by one where the object is as small as here.
Difference smooth_difference(const Composite& a, const Composite& b, const FrameView& view) {
  EXPECT_EQ(a.rect, b.rect);
  cv::Mat apart(a.rect.height, a.rect.width, CV_32FC4);
  for (std::size_t i = 0; i < a.rgba.size(); ++i) apart.ptr<float>()[i] = 255 * (a.rgba[i] - b.rgba[i]);
  cv::blur(apart, apart, {7, 7});
  std::vector<double> largest(static_cast<std::size_t>(view.camera.width_px) * view.camera.height_px, 0.0);
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    if (i % 4 < 3) largest[i / 4] = std::max<double>(largest[i / 4], std::abs(apart.ptr<float>()[i]));
  std::ranges::sort(largest);
  return {std::accumulate(largest.begin(), largest.end(), 0.0) / static_cast<double>(largest.size()),
          largest[largest.size() * 99 / 100]};
}

TEST_F(MetalGl, BothRenderersFollowMetalToMetalAlike) {
  const FrameView view = view_from_above(0.36);
  const Mesh mesh = knot();
  for (const float roughness : {0.05f, 0.2f, 0.35f}) {
    RenderScene scene = constant_scene(mesh, metal({0.95f, 0.6f, 0.5f}, roughness), glm::vec3(1));
    scene.reflections =
        reflections_of([](const glm::dvec3& d) { return glm::vec3(0.4 + 0.3 * d.z + 0.1 * std::sin(5 * d.x)); }, 64, 5);
    const Composite gl = GlCompositor(scene, without_glare()).render(view, plate_u8(100));
    const Composite cpu = CpuCompositor(scene, without_glare()).render(view, plate_u8(100));
    const auto [mean, percentile99] = smooth_difference(gl, cpu, view);
    // Where metal is not followed to metal, the mean is 1.3 and more, and the percentile 14.
    EXPECT_LE(mean, 0.3) << "roughness " << roughness;
    EXPECT_LE(percentile99, 3) << "roughness " << roughness;
  }
}

}  // namespace
}  // namespace catchlight::render::test
