// The map between the picture and the tag's plane, as an inverse pair and against the lens's own projection.
#include "tracking/refinement/tag_view.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/projection.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"
#include "tests/support/synthetic_tag.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

constexpr double kSize_m = 0.12;
constexpr int kCells = 8;

/// Focal lengths that differ, so that x and y cannot be confused; the lens's distortion must not matter.
CameraModel camera() {
  CameraModel camera = distorted_camera();
  camera.fy_px = 610;
  return camera;
}

RigidTransform pose() {
  return tag_pose(camera(), {250, 200}, 0.5, {35, -40, 20});
}

TagView view() {
  return {camera(), pose(), kSize_m, kCells};
}

TEST(TagView, APixelsCellIsSeenAtThatPixel) {
  for (double y = 120; y < 300; y += 13)
    for (double x = 160; x < 340; x += 17) {
      const auto point = view().at({x, y});
      ASSERT_TRUE(point);
      const auto back = view().ideal_px(point->cell);
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->x, x, 1e-9);
      EXPECT_NEAR(back->y, y, 1e-9);
    }
}

TEST(TagView, CellsRunRightAndDownFromTheTopLeftCorner) {
  // The tag's frame has y up: corner (-,-) is at the bottom left, cell (0, 8).
  const double h = kSize_m / 2;
  const std::pair<glm::dvec2, glm::dvec3> corners[] = {
      {{0, kCells}, {-h, -h, 0}}, {{kCells, kCells}, {h, -h, 0}}, {{kCells, 0}, {h, h, 0}}, {{0, 0}, {-h, h, 0}}};
  for (const auto& [cell, corner_m] : corners) {
    const auto expected = project_ideal_px(camera(), pose() * corner_m), seen = view().ideal_px(cell);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->x, expected->x, 1e-9);
    EXPECT_NEAR(seen->y, expected->y, 1e-9);
  }
}

TEST(TagView, ThePointLiesOnTheTagsPlaneAndOnThePixelsRay) {
  const auto point = view().at({231.5, 188.25});
  ASSERT_TRUE(point);
  const glm::dvec3 on_tag_m = inverse(pose()) * point->point_camera_m;
  EXPECT_NEAR(on_tag_m.z, 0, 1e-12);
  EXPECT_NEAR((on_tag_m.x / kSize_m + 0.5) * kCells, point->cell.x, 1e-9);
  EXPECT_NEAR((0.5 - on_tag_m.y / kSize_m) * kCells, point->cell.y, 1e-9);
  const auto seen = project_ideal_px(camera(), point->point_camera_m);
  EXPECT_NEAR(seen->x, 231.5, 1e-9);
  EXPECT_NEAR(seen->y, 188.25, 1e-9);
}

TEST(TagView, CellsPerPixelAreTheSlopesOfTheMap) {
  constexpr double kStep_px = 1e-3;
  for (const glm::dvec2 px : {glm::dvec2(231, 188), glm::dvec2(300, 240), glm::dvec2(200, 150)}) {
    const glm::dmat2 cell_per_px = view().at(px)->cell_per_px;
    for (int axis = 0; axis < 2; ++axis) {
      glm::dvec2 step(0);
      step[axis] = kStep_px;
      const glm::dvec2 slope = (view().at(px + step)->cell - view().at(px - step)->cell) / (2 * kStep_px);
      EXPECT_NEAR(cell_per_px[axis].x, slope.x, 1e-7);
      EXPECT_NEAR(cell_per_px[axis].y, slope.y, 1e-7);
    }
  }
}

TEST(TagView, ASpreadOfPixelsIsTheSpreadOfTheirCells) {
  // Covariances from the definition: pixels on an ellipse, mapped one by one by the local slopes.
  const glm::dmat2 cell_per_px = view().at({231, 188})->cell_per_px;
  const glm::dvec2 axes_px[] = {{0.9, 0.2}, {-0.1, 0.4}};
  const auto spread = [](const glm::dvec2& a, const glm::dvec2& b) {
    return Covariance2{a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y};
  };
  const Covariance2 expected = spread(cell_per_px * axes_px[0], cell_per_px * axes_px[1]);
  const Covariance2 seen = in_cells(spread(axes_px[0], axes_px[1]), cell_per_px);
  EXPECT_NEAR(seen.xx, expected.xx, 1e-15);
  EXPECT_NEAR(seen.xy, expected.xy, 1e-15);
  EXPECT_NEAR(seen.yy, expected.yy, 1e-15);
}

TEST(TagView, NothingIsSeenAboveTheHorizonOrBehindTheCamera) {
  // Leaning 80° back, the plane's horizon is 10° above the tag's middle.
  const RigidTransform leaning = tag_pose(plain_camera(), {319.5, 239.5}, 0.5, {-80, 0, 0});
  const TagView view(plain_camera(), leaning, kSize_m, kCells);
  const double horizon_px = 600 * std::tan(10 * M_PI / 180);
  const bool horizon_is_above = view.at({319.5, 239.5 - horizon_px - 2}) == std::nullopt;
  const double towards_horizon = horizon_is_above ? -1 : 1;
  EXPECT_FALSE(view.at({319.5, 239.5 + towards_horizon * (horizon_px + 2)}));
  EXPECT_TRUE(view.at({319.5, 239.5 + towards_horizon * (horizon_px - 2)}));
  const double behind_cells = 0.51 / kSize_m * kCells;  // half a metre along the plane is where the camera stands
  EXPECT_FALSE(view.ideal_px({4, 4 + (horizon_is_above ? 1 : -1) * behind_cells}));
}

}  // namespace
}  // namespace catchlight::tracking
