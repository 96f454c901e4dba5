// Where things land in the picture: OpenCV's projection decides.
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <random>

#include "catchlight/camera.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

template <typename Renderer>
using ProjectionGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(ProjectionGl, Renderers, RendererNames);

std::vector<cv::Point2d> project(const FrameView& view, const std::vector<cv::Point3d>& points_tag) {
  const CameraModel& camera = view.camera;
  const cv::Matx33d matrix(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  cv::Matx33d rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rotation(row, column) = view.camera_from_tag.rotation[column][row];
  cv::Vec3d rotation_vector;
  cv::Rodrigues(rotation, rotation_vector);
  const glm::dvec3& t = view.camera_from_tag.translation_m;
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points_tag, rotation_vector, cv::Vec3d(t.x, t.y, t.z), matrix,
                    std::vector<double>(camera.distortion.begin(), camera.distortion.end()), pixels);
  return pixels;
}

/// Light-weighted centre of the red channel.
glm::dvec2 centroid(const Composite& composite) {
  glm::dvec2 sum(0);
  double weight = 0;
  for (int y = composite.rect.y; y < composite.rect.y + composite.rect.height; ++y) {
    for (int x = composite.rect.x; x < composite.rect.x + composite.rect.width; ++x) {
      const double value = pixel_at(composite, x, y).x;
      sum += value * glm::dvec2(x, y);
      weight += value;
    }
  }
  return sum / weight;
}

constexpr int kCorners = 64;

std::vector<cv::Point3d> disc_corners(const glm::dvec2& center_m, double radius_m) {
  std::vector<cv::Point3d> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    corners.emplace_back(center_m.x + radius_m * std::cos(angle), center_m.y + radius_m * std::sin(angle), 0);
  }
  return corners;
}

/// Area centroid of a polygon (shoelace formula).
glm::dvec2 polygon_centroid(const std::vector<cv::Point2d>& corners) {
  glm::dvec2 sum(0);
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double cross = a.cross(b);
    area += cross / 2;
    sum += glm::dvec2(a.x + b.x, a.y + b.y) * cross / 6.0;
  }
  return sum / area;
}

RenderScene white_disc(const glm::dvec2& center_m, double radius_m) {
  Mesh mesh;
  for (const cv::Point3d& corner : disc_corners(center_m, radius_m)) {
    mesh.vertices.push_back({glm::vec3(corner.x, corner.y, 0), glm::vec3(0, 0, 1), glm::vec3(1)});
  }
  for (std::uint32_t i = 2; i < kCorners; ++i) mesh.indices.insert(mesh.indices.end(), {0, i - 1, i});
  mesh.triangle_material.assign(kCorners - 2, 0);
  Material white;
  white.base_color = glm::vec3(1);
  white.dielectric_f0 = 0;
  return constant_scene(mesh, white, glm::vec3(1));
}

FrameView tilted_view(std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-0.5, 0.5), shift(-0.02, 0.02);
  FrameView view = view_from_above();
  cv::Matx33d rotation;
  cv::Rodrigues(cv::Vec3d(std::numbers::pi + angle(random), angle(random), angle(random)), rotation);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) view.camera_from_tag.rotation[column][row] = rotation(row, column);
  view.camera_from_tag.translation_m = {shift(random), shift(random), 0.5};
  view.color.transfer = TransferFunction::linear;
  view.camera.cx_px = 81.3;
  view.camera.cy_px = 57.9;
  return view;
}

TYPED_TEST(ProjectionGl, PixelCentresAreOpenCvs) {
  CompositorSettings settings;
  settings.samples = 4;
  std::mt19937 random(3);
  const PlateReader black = plate_f32([](int, int) { return glm::vec3(0); });
  const glm::dvec2 center(0.02, -0.01);
  TypeParam compositor(white_disc(center, 0.02), settings);
  for (const auto& distortion : {std::array<double, 8>{}, std::array<double, 8>{-0.3, 0.1, 0.002, -0.001, 0, 0, 0, 0}}) {
    glm::dvec2 bias(0);
    constexpr int kViews = 40;
    for (int i = 0; i < kViews; ++i) {
      FrameView view = tilted_view(random);
      view.camera.distortion = distortion;
      const glm::dvec2 expected = polygon_centroid(project(view, disc_corners(center, 0.02)));
      const glm::dvec2 error = centroid(compositor.render(view, black)) - expected;
      // Four samples know a pixel's coverage to 0.1; 50 pixels of outline 8 px from the middle of an area of 200 make that 0.02
      // px, here 3.5 sigma.
      EXPECT_LT(glm::length(error), 0.07);
      bias += error / double{kViews};
    }
    // A wrong pixel convention would be 0.5 px.
    EXPECT_LT(glm::length(bias), 0.02) << bias.x << ", " << bias.y;
  }
}

TYPED_TEST(ProjectionGl, PictureRightIsTagRightAndPictureUpIsTagUp) {
  const PlateReader black = plate_f32([](int, int) { return glm::vec3(0); });
  FrameView view = view_from_above();
  view.color.transfer = TransferFunction::linear;
  const glm::dvec2 right = centroid(TypeParam(white_disc({0.05, 0}, 0.02), {}).render(view, black));
  const glm::dvec2 up = centroid(TypeParam(white_disc({0, 0.05}, 0.02), {}).render(view, black));
  EXPECT_NEAR(right.x, 79.5 + 20, 0.05);
  EXPECT_NEAR(right.y, 59.5, 0.05);
  EXPECT_NEAR(up.x, 79.5, 0.05);
  EXPECT_NEAR(up.y, 59.5 - 20, 0.05);
}

TYPED_TEST(ProjectionGl, TheNearerSurfaceHidesTheFarther) {
  Material red, green;
  red.base_color = {1, 0, 0};
  green.base_color = {0, 1, 0};
  red.dielectric_f0 = green.dielectric_f0 = 0;
  Mesh mesh = square({-0.02, -0.02}, {0.02, 0.02}, 0.1);
  const Mesh far = square({-0.05, -0.05}, {0.05, 0.05}, 0.0);
  mesh.vertices.insert(mesh.vertices.end(), far.vertices.begin(), far.vertices.end());
  mesh.indices.insert(mesh.indices.end(), {4, 5, 6, 4, 6, 7});
  mesh.triangle_material.insert(mesh.triangle_material.end(), {1, 1});
  mesh.materials = {red, green};
  const RenderScene scene = constant_scene(mesh, red, glm::vec3(1));
  FrameView view = view_from_above();
  view.color.transfer = TransferFunction::linear;
  const Composite composite = TypeParam(scene, {}).render(view, plate_u8(0));
  EXPECT_NEAR(pixel_at(composite, 80, 60).x, 1, 1e-4);
  EXPECT_NEAR(pixel_at(composite, 80, 60).y, 0, 1e-4);
  EXPECT_NEAR(pixel_at(composite, 95, 60).y, 1, 1e-4);
}

}  // namespace
}  // namespace catchlight::render::test
