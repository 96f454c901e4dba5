// The sums over a cell's pixels, against planes fitted to the pixels themselves.
#include "tracking/camera/flat_cells.hpp"

#include <gtest/gtest.h>

#include <map>
#include <opencv2/core.hpp>
#include <random>

#include "tests/support/synthetic_tag.hpp"
#include "tests/tracking/camera/light_fixture.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/refinement/ideal_pixels.hpp"
#include "tracking/refinement/tag_pattern.hpp"
#include "tracking/refinement/tag_view.hpp"

namespace catchlight::tracking {
namespace {

const BundledTag kTag{"tag36h11", 5, 0.08, {}};
constexpr Covariance2 kBlur_px2{0.5, 0, 0.5};

/// Noise on a slant, lower than clipping.
Light noisy_light(const CameraModel& camera) {
  Light light{camera.width_px, camera.height_px, {}};
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 0.01f);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x)
      light.rgb.emplace_back(0.3f + 2e-4f * static_cast<float>(x + 2 * y) + noise(random));
  return light;
}

/// Each cell's pixels, every one's place found by itself.
std::map<int, std::vector<glm::ivec2>> pixels_of_cells(const CameraModel& camera, const RigidTransform& pose, int side) {
  const TagPattern pattern(tag_layout(kTag.family, kTag.id));
  const TagView view(camera, pose, kTag.size_m, pattern.cells_across());
  const double reach_px = 3 * std::sqrt(kBlur_px2.xx) + 1;
  const int margin = (side - pattern.cells_across()) / 2;
  std::map<int, std::vector<glm::ivec2>> pixels;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const auto place = ideal_pixel(camera, {x, y});
      const auto point = place ? view.at(place->ideal_px) : std::nullopt;
      if (!point) continue;
      const Covariance2 reach =
          in_cells({reach_px * reach_px, 0, reach_px * reach_px}, point->cell_per_px * place->ideal_per_seen);
      const glm::ivec2 cell = glm::ivec2(glm::floor(point->cell)) + margin;
      if (cell.x < 0 || cell.y < 0 || cell.x >= side || cell.y >= side) continue;
      if (pattern.around(point->cell, {std::sqrt(reach.xx), std::sqrt(reach.yy)}) == TagPattern::Neighbourhood::plateau)
        pixels[cell.y * side + cell.x].emplace_back(x, y);
    }
  return pixels;
}

/// Sum of the squares that the best plane leaves.
double left_by_plane(const Light& light, const std::vector<glm::ivec2>& pixels) {
  cv::Mat1d base(static_cast<int>(pixels.size()), 3), values(static_cast<int>(pixels.size()), 1), plane;
  for (int i = 0; i < base.rows; ++i) {
    const glm::ivec2 at = pixels[static_cast<std::size_t>(i)];
    base(i, 0) = 1, base(i, 1) = at.x, base(i, 2) = at.y;
    values(i) = static_cast<double>(light.rgb[static_cast<std::size_t>(at.y * light.width_px + at.x)].g);
  }
  cv::solve(base, values, plane, cv::DECOMP_SVD);
  return std::pow(cv::norm(values - base * plane), 2);
}

class FlatCellsOf : public ::testing::TestWithParam<CameraModel> {};

TEST_P(FlatCellsOf, HoldThePixelsThatNoEdgeReachesAndTheirSums) {
  const CameraModel& camera = GetParam();
  const Light light = noisy_light(camera);
  const RigidTransform pose = tag_pose(camera, {300, 250}, 0.5, {25, -20, 15});
  const std::vector<FlatCell> cells = flat_cells(light.codes(), camera, pose, kTag, kBlur_px2);
  const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(cells.size()))));
  int compared = 0;
  double count = 0, expected_count = 0;
  for (const auto& [index, pixels] : pixels_of_cells(camera, pose, side)) {
    const FlatCell& cell = cells[static_cast<std::size_t>(index)];
    count += cell.pixels.n, expected_count += static_cast<double>(pixels.size());
    // Where a place between two exact ones falls on the other side of a limit, the sums are another pixel set's.
    if (cell.pixels.n != static_cast<double>(pixels.size()) || pixels.size() < 9) continue;
    const double left = left_over(cell.luma_square, cell.luma, cell.luma, cell.pixels.inverse());
    EXPECT_NEAR(left / left_by_plane(light, pixels), 1, 0.1) << "cell " << index;
    compared += 1;
  }
  EXPECT_NEAR(count / expected_count, 1, 0.01);
  EXPECT_GT(compared, 50);
}

INSTANTIATE_TEST_SUITE_P(Cameras, FlatCellsOf, ::testing::Values(plain_camera(), distorted_camera()),
                         [](const auto& test) { return test.param.has_distortion() ? "distorted" : "plain"; });

}  // namespace
}  // namespace catchlight::tracking
