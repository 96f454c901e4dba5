#include "tests/support/synthetic_tag.hpp"

#include <apriltag/apriltag.h>

#include <cstdlib>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "catchlight/color.hpp"
#include "catchlight/pixel_rect.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kRaysAcross = 8;  ///< rays along a side of a pixel

cv::Matx33d intrinsics(const CameraModel& camera) {
  return {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
}

std::vector<double> coefficients(const CameraModel& camera) {
  return {camera.distortion.begin(), camera.distortion.end()};
}

/// Debian's library does not export its own image_u8_destroy().
struct FreeImage {
  void operator()(image_u8_t* image) const {
    std::free(image->buf);
    std::free(image);
  }
};

/// What is printed, in cells from the top left of the detected square, columns right and rows down.
class Print {
 public:
  Print(const SyntheticTag& tag, double paper_margin_cells)
      : family_(create_family(tag.target.family)),
        image_(apriltag_to_image(family_.get(), static_cast<std::uint32_t>(tag.target.id))),
        margin_((family_->total_width - family_->width_at_border) / 2),
        reach_(margin_ + paper_margin_cells),
        cells_per_m_(family_->width_at_border / tag.target.size_m) {}

  enum class Surface { none, white, black };

  double reach_m() const { return (cells_across() / 2.0 + reach_) / cells_per_m_; }

  Surface at(double x_m, double y_m) const {
    const double column = x_m * cells_per_m_ + cells_across() / 2.0, row = cells_across() / 2.0 - y_m * cells_per_m_;
    const double beyond = std::max({-column, -row, column - cells_across(), row - cells_across()});
    if (beyond > reach_) return Surface::none;
    if (beyond >= margin_) return Surface::white;
    const int x = static_cast<int>(std::floor(column)) + margin_, y = static_cast<int>(std::floor(row)) + margin_;
    return image_->buf[y * image_->stride + x] > 127 ? Surface::white : Surface::black;
  }

 private:
  int cells_across() const { return family_->width_at_border; }

  FamilyPtr family_;
  std::unique_ptr<image_u8_t, FreeImage> image_;
  int margin_;
  double reach_, cells_per_m_;
};

std::vector<cv::Point2d> projected(const CameraModel& camera, const RigidTransform& camera_from_tag,
                                   const std::vector<cv::Point3d>& points_m) {
  cv::Matx33d rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rotation(row, column) = camera_from_tag.rotation[column][row];
  const glm::dvec3 t = camera_from_tag.translation_m;
  cv::Vec3d rotation_vector;
  cv::Rodrigues(rotation, rotation_vector);
  std::vector<cv::Point2d> points_px;
  cv::projectPoints(points_m, rotation_vector, cv::Vec3d(t.x, t.y, t.z), intrinsics(camera), coefficients(camera), points_px);
  return points_px;
}

/// Ray slopes (x/z, y/z) at every pixel corner of `rect`, (width + 1) x (height + 1).
std::vector<cv::Point2d> corner_slopes(const CameraModel& camera, const PixelRect& rect) {
  std::vector<cv::Point2d> corners, slopes;
  for (int y = 0; y <= rect.height; ++y)
    for (int x = 0; x <= rect.width; ++x) corners.emplace_back(rect.x + x - 0.5, rect.y + y - 0.5);
  const cv::TermCriteria until(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 100, 1e-12);
  cv::undistortPoints(corners, slopes, intrinsics(camera), coefficients(camera), cv::noArray(), cv::noArray(), until);
  return slopes;
}

/// The pixels around a tag that its blurred print may reach.
PixelRect tag_region(const SyntheticScene& scene, const SyntheticTag& tag, const Print& print) {
  const double r = print.reach_m();
  const auto outline = projected(scene.camera, tag.camera_from_tag,
                                 {{-r, -r, 0}, {r, -r, 0}, {r, r, 0}, {-r, r, 0}, {0, -r, 0}, {r, 0, 0}, {0, r, 0}, {-r, 0, 0}});
  const cv::Rect2d box = cv::boundingRect(std::vector<cv::Point2f>(outline.begin(), outline.end()));
  const double pad = 4 + 4 * scene.blur_px;
  const PixelRect padded{static_cast<int>(box.x - pad), static_cast<int>(box.y - pad), static_cast<int>(box.width + 2 * pad),
                         static_cast<int>(box.height + 2 * pad)};
  return intersect(padded, {0, 0, scene.camera.width_px, scene.camera.height_px});
}

/// Coverage-weighted light of one region: rays against the plane, Gaussian blur of the fine grid, then the pixel's mean.
cv::Mat1f render_region(const SyntheticScene& scene, const SyntheticTag& tag, const Print& print, const PixelRect& rect,
                        const cv::Mat1f& below) {
  cv::Mat1f fine(rect.height * kRaysAcross, rect.width * kRaysAcross);
  const auto slopes = corner_slopes(scene.camera, rect);
  const RigidTransform tag_from_camera{glm::transpose(tag.camera_from_tag.rotation),
                                       -(glm::transpose(tag.camera_from_tag.rotation) * tag.camera_from_tag.translation_m)};
  const glm::dvec3 eye_m = tag_from_camera.translation_m;
  // Rays are scattered within their cells: in a regular grid, all those along an upright edge would cross it together.
  std::mt19937 random(1);
  const auto scatter = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int y = 0; y < fine.rows; ++y)
    for (int x = 0; x < fine.cols; ++x) {
      // Within one pixel the lens is linear to 1e-5 px.
      const double u = (x % kRaysAcross + scatter()) / kRaysAcross, v = (y % kRaysAcross + scatter()) / kRaysAcross;
      const cv::Point2d* top = &slopes[static_cast<std::size_t>(y / kRaysAcross * (rect.width + 1) + x / kRaysAcross)];
      const cv::Point2d* bottom = top + rect.width + 1;
      const cv::Point2d slope = (1 - v) * ((1 - u) * top[0] + u * top[1]) + v * ((1 - u) * bottom[0] + u * bottom[1]);
      const glm::dvec3 ray = tag_from_camera.rotation * glm::dvec3(slope.x, slope.y, 1);
      const double depth = -eye_m.z / ray.z;
      const auto surface = depth > 0 ? print.at(eye_m.x + depth * ray.x, eye_m.y + depth * ray.y) : Print::Surface::none;
      fine(y, x) = surface == Print::Surface::none    ? below(y / kRaysAcross, x / kRaysAcross)
                   : surface == Print::Surface::white ? static_cast<float>(scene.white_linear)
                                                      : static_cast<float>(scene.black_linear);
    }
  if (scene.blur_px > 0)
    cv::GaussianBlur(fine, fine, {}, scene.blur_px * kRaysAcross, scene.blur_px * kRaysAcross, cv::BORDER_REPLICATE);
  cv::Mat1f coarse;
  cv::resize(fine, coarse, {rect.width, rect.height}, 0, 0, cv::INTER_AREA);
  return coarse;
}

}  // namespace

SyntheticFrame render(const SyntheticScene& scene) {
  cv::Mat1f image(scene.camera.height_px, scene.camera.width_px, static_cast<float>(scene.background_linear));
  for (const SyntheticTag& tag : scene.tags) {
    const Print print(tag, scene.paper_margin_cells);
    const PixelRect rect = tag_region(scene, tag, print);
    if (rect.empty()) continue;
    cv::Mat1f region = image(cv::Rect(rect.x, rect.y, rect.width, rect.height));
    render_region(scene, tag, print, rect, region.clone()).copyTo(region);
  }
  SyntheticFrame frame{image.cols, image.rows, {image.begin(), image.end()}, {}};
  frame.codes = expose(frame.linear, scene.noise_codes, scene.seed);
  return frame;
}

std::vector<std::uint8_t> expose(const std::vector<float>& linear, double noise_codes, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<std::uint8_t> codes;
  codes.reserve(linear.size());
  for (const float light : linear) {
    const double noise = noise_codes > 0 ? noise_codes * normal(random) : 0;
    codes.push_back(cv::saturate_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(light) + noise)));
  }
  return codes;
}

RigidTransform tag_pose(const CameraModel& camera, const glm::dvec2& center_px, double distance_m, const glm::dvec3& turn_deg) {
  const glm::dvec3 turn = glm::radians(turn_deg);
  const auto rotation_about = [](int axis, double angle) {
    glm::dmat3 rotation(1.0);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    rotation[a][a] = rotation[b][b] = std::cos(angle);
    rotation[a][b] = std::sin(angle);
    rotation[b][a] = -std::sin(angle);
    return rotation;
  };
  const glm::dmat3 facing{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};  // tag x right, y up, z towards the camera
  const glm::dvec3 translation_m =
      distance_m * glm::dvec3((center_px.x - camera.cx_px) / camera.fx_px, (center_px.y - camera.cy_px) / camera.fy_px, 1);
  return {rotation_about(2, turn.z) * rotation_about(1, turn.y) * rotation_about(0, turn.x) * facing, translation_m};
}

std::array<glm::dvec2, 4> true_corners_px(const CameraModel& camera, const SyntheticTag& tag) {
  const double h = tag.target.size_m / 2;
  const auto corners = projected(camera, tag.camera_from_tag, {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
  std::array<glm::dvec2, 4> result;
  for (int i = 0; i < 4; ++i) result[i] = {corners[i].x, corners[i].y};
  return result;
}

CameraModel plain_camera() {
  return {640, 480, 600, 600, 319.5, 239.5, {}};
}

CameraModel distorted_camera() {
  return {640, 480, 520, 524, 331.2, 236.7, {-0.31, 0.12, 0.0011, -0.0007, -0.02, 0.01, 0.005, 0.001}};
}

double rms_distance(const std::array<glm::dvec2, 4>& a, const std::array<glm::dvec2, 4>& b) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += glm::dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum / 4);
}

double outward_bias_px(const std::array<glm::dvec2, 4>& found, const std::array<glm::dvec2, 4>& truth) {
  const glm::dvec2 center = (truth[0] + truth[1] + truth[2] + truth[3]) / 4.0;
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += glm::dot(found[i] - truth[i], glm::normalize(truth[i] - center));
  return sum / 4;
}

}  // namespace catchlight::tracking
