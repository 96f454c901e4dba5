#include "tests/support/board_picture.hpp"

#include <apriltag/apriltag.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "catchlight/color.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::tests {
namespace {

constexpr int kRaysAcross = 4;  ///< rays along a side of a pixel
constexpr double kWhite = 0.6, kBlack = 0.03, kBackground = 0.2, kBlurPx = 0.7;

/// Slopes x/z, y/z of the ray that the lens puts at `px`.
glm::dvec2 ray_slope(const CameraModel& camera, const glm::dvec2& px) {
  const auto [k1, k2, p1, p2] =
      std::array{camera.distortion[0], camera.distortion[1], camera.distortion[2], camera.distortion[3]};
  const glm::dvec2 distorted((px.x - camera.cx_px) / camera.fx_px, (px.y - camera.cy_px) / camera.fy_px);
  glm::dvec2 p = distorted;
  for (int i = 0; i < 15; ++i) {
    const double r2 = glm::dot(p, p);
    const glm::dvec2 tangential(2 * p1 * p.x * p.y + p2 * (r2 + 2 * p.x * p.x), p1 * (r2 + 2 * p.y * p.y) + 2 * p2 * p.x * p.y);
    p = (distorted - tangential) / (1 + k1 * r2 + k2 * r2 * r2);
  }
  return p;
}

/// Mean light of every pixel's square.
cv::Mat1f pixel_light(const CameraModel& camera, const RigidTransform& camera_from_board, const BoardLight& light) {
  const RigidTransform board_from_camera = inverse(camera_from_board);
  const glm::dvec3 eye_m = board_from_camera.translation_m;
  cv::Mat1f picture(camera.height_px, camera.width_px, 0.0f);
  std::vector<glm::dvec2> slopes;  // at the pixels' top left corners
  for (int y = 0; y <= picture.rows; ++y)
    for (int x = 0; x <= picture.cols; ++x) slopes.push_back(ray_slope(camera, {x - 0.5, y - 0.5}));
  // Rays are scattered within their cells: in a regular grid, all those along an upright edge would cross it together.
  std::mt19937 random(1);
  const auto scatter = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      // Within a pixel the lens is linear to a thousandth of one.
      const glm::dvec2 slope = slopes[y * (picture.cols + 1) + x];
      const glm::dvec2 right = slopes[y * (picture.cols + 1) + x + 1] - slope;
      const glm::dvec2 down = slopes[(y + 1) * (picture.cols + 1) + x] - slope;
      double sum = 0;
      for (int i = 0; i < kRaysAcross * kRaysAcross; ++i) {
        const double u = (i % kRaysAcross + scatter()) / kRaysAcross, v = (i / kRaysAcross + scatter()) / kRaysAcross;
        const glm::dvec3 ray = board_from_camera.rotation * glm::dvec3(slope + u * right + v * down, 1);
        const double depth = -eye_m.z / ray.z;
        sum += depth > 0 ? light(glm::dvec2(eye_m + depth * ray)) : kBackground;
      }
      picture(y, x) = static_cast<float>(sum / (kRaysAcross * kRaysAcross));
    }
  return picture;
}

/// Cells of the detected square, rows down; true where white.
std::vector<std::vector<bool>> tag36h11_cells(int id) {
  const auto family = tracking::create_family("tag36h11");
  image_u8_t* drawing = apriltag_to_image(family.get(), static_cast<std::uint32_t>(id));
  std::vector<std::vector<bool>> cells(8, std::vector<bool>(8));
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 8; ++column) cells[row][column] = drawing->buf[(row + 1) * drawing->stride + column + 1] > 127;
  std::free(drawing->buf);
  std::free(drawing);
  return cells;
}

}  // namespace

BoardLight checkerboard(int inner_columns, int inner_rows, double square_m) {
  return [=](const glm::dvec2& point_m) {
    const glm::dvec2 across(inner_columns + 1, inner_rows + 1);
    const glm::dvec2 squares = point_m / square_m + across / 2.0;
    const glm::dvec2 beyond = glm::max(-squares, squares - across);
    const double outside = std::max(beyond.x, beyond.y);
    if (outside > 0) return outside > 1 ? kBackground : kWhite;
    const int sum = static_cast<int>(std::floor(squares.x)) + static_cast<int>(std::floor(squares.y));
    return sum % 2 == 0 ? kBlack : kWhite;
  };
}

BoardLight tag_board(int columns, int rows, double size_m, double spacing_m, int first_id) {
  std::vector<std::vector<std::vector<bool>>> tags;
  for (int i = 0; i < columns * rows; ++i) tags.push_back(tag36h11_cells(first_id + i));
  return [=](const glm::dvec2& point_m) {
    // In tags from the top left one's centre, columns right, rows down.
    const double right = point_m.x / spacing_m + (columns - 1) / 2.0, down = (rows - 1) / 2.0 - point_m.y / spacing_m;
    const double edge = size_m / 2 * 1.25 / spacing_m;  // a cell is an eighth of the size
    if (right < -edge || down < -edge || right > columns - 1 + edge || down > rows - 1 + edge) return kBackground;
    const int column = std::clamp(static_cast<int>(std::lround(right)), 0, columns - 1);
    const int row = std::clamp(static_cast<int>(std::lround(down)), 0, rows - 1);
    const double x = ((right - column) * spacing_m / size_m + 0.5) * 8, y = ((down - row) * spacing_m / size_m + 0.5) * 8;
    if (x < 0 || y < 0 || x >= 8 || y >= 8) return kWhite;
    return tags[row * columns + column][static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] ? kWhite : kBlack;
  };
}

BoardLight printed(const cv::Mat1b& picture, double pixels_per_m) {
  return [=](const glm::dvec2& point_m) {
    const int x = static_cast<int>(std::floor(picture.cols / 2.0 + point_m.x * pixels_per_m));
    const int y = static_cast<int>(std::floor(picture.rows / 2.0 - point_m.y * pixels_per_m));
    if (x < 0 || y < 0 || x >= picture.cols || y >= picture.rows) return kBackground;
    return kBlack + (kWhite - kBlack) * picture(y, x) / 255;
  };
}

cv::Mat1b board_picture(const CameraModel& camera, const RigidTransform& camera_from_board, const BoardLight& light,
                        unsigned seed) {
  cv::Mat1f linear = pixel_light(camera, camera_from_board, light);
  cv::GaussianBlur(linear, linear, {}, kBlurPx);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  cv::Mat1b codes(linear.size());
  std::transform(linear.begin(), linear.end(), codes.begin(),
                 [&](float value) { return cv::saturate_cast<std::uint8_t>(255 * srgb_from_linear(value) + noise(random)); });
  return codes;
}

}  // namespace catchlight::tests
