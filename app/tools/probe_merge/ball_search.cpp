#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "app/tools/probe_merge/ball.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSearchSidePx = 640;  ///< Hough's circle is sought in a picture this small
constexpr double kDarkest = 1e-3;   ///< share of the median; below it noise has edges, too

/// Logarithm of luminance, as an edge is one in any exposure; 1 is a factor of two.
cv::Mat log_luminance(const Image& radiance) {
  cv::Mat picture(radiance.height, radiance.width, CV_32F);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const float* rgb = radiance.pixel(x, y);
      picture.at<float>(y, x) = static_cast<float>(glm::dot(kLuminanceWeights, glm::dvec3(rgb[0], rgb[1], rgb[2])));
    }
  std::vector<float> values(picture.begin<float>(), picture.end<float>());
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  const double floor = std::max(kDarkest * values[values.size() / 2], 1e-30);
  picture.forEach<float>([floor](float& value, const int*) { value = static_cast<float>(std::log2(value + floor)); });
  return picture;
}

/// 8-bit codes of 4 stops up and down from the median: what Hough's transform takes.
cv::Mat codes_for_search(const cv::Mat& log_picture, double scale) {
  cv::Mat small, codes;
  cv::resize(log_picture, small, {}, scale, scale, cv::INTER_AREA);
  std::vector<float> values(small.begin<float>(), small.end<float>());
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  const double median = values[values.size() / 2];
  small.convertTo(codes, CV_8U, 32, 128 - 32 * median);
  cv::medianBlur(codes, codes, 5);
  return codes;
}

std::vector<BallCircle> candidates(const cv::Mat& log_picture) {
  const double scale = std::min(1.0, static_cast<double>(kSearchSidePx) / std::max(log_picture.cols, log_picture.rows));
  const cv::Mat codes = codes_for_search(log_picture, scale);
  const int side = std::min(codes.cols, codes.rows);
  std::vector<cv::Vec3f> found;
  cv::HoughCircles(codes, found, cv::HOUGH_GRADIENT, 1.5, side / 20.0, 100, 20, side / 20, side / 2);
  constexpr std::size_t kMaxCandidates = 12;
  std::vector<BallCircle> circles;
  for (std::size_t i = 0; i < std::min(found.size(), kMaxCandidates); ++i)
    circles.push_back({(glm::dvec2(found[i][0], found[i][1]) + 0.5) / scale - 0.5, found[i][2] / scale});
  return circles;
}

float at(const cv::Mat& picture, const glm::dvec2& px) {
  const int x = std::clamp(static_cast<int>(std::floor(px.x)), 0, picture.cols - 2);
  const int y = std::clamp(static_cast<int>(std::floor(px.y)), 0, picture.rows - 2);
  const float right = static_cast<float>(px.x - x), down = static_cast<float>(px.y - y);
  const float top = glm::mix(picture.at<float>(y, x), picture.at<float>(y, x + 1), right);
  return glm::mix(top, glm::mix(picture.at<float>(y + 1, x), picture.at<float>(y + 1, x + 1), right), down);
}

/// The radii at which the picture is steeper than around, along a ray from the circle's centre. Only steps count: towards the rim
/// reflections are pressed together, and slope more than many a silhouette.
std::vector<double> edge_radii(const cv::Mat& log_picture, const BallCircle& circle, const glm::dvec2& outward, double reach_px) {
  constexpr double kMinStep = 0.05, kStepPx = 0.25, kHalfPx = 0.5, kSharper = 2;
  const double aside_px = std::max(2.0, 0.015 * circle.radius_px);
  const auto steepness = [&](double radius) {
    return std::abs(at(log_picture, circle.centre_px + (radius + kHalfPx) * outward) -
                    at(log_picture, circle.centre_px + (radius - kHalfPx) * outward));
  };
  std::vector<double> radii;
  for (double radius = circle.radius_px - reach_px; radius <= circle.radius_px + reach_px; radius += kStepPx) {
    const double here = steepness(radius);
    if (here < kMinStep || here <= steepness(radius - kStepPx) || here < steepness(radius + kStepPx)) continue;
    if (here > kSharper * std::max(steepness(radius - aside_px), steepness(radius + aside_px))) radii.push_back(radius);
  }
  return radii;
}

/// An edge near `radius`, where the light is midway between both sides: lenses and pixels blur light, not its logarithm.
double refined_radius(const cv::Mat& log_picture, const glm::dvec2& centre, const glm::dvec2& outward, double radius) {
  constexpr double kSidePx = 1.25, kStepPx = 0.125;
  const auto light = [&](double r) { return std::exp2(at(log_picture, centre + r * outward)); };
  const double inner = light(radius - kSidePx), middle = (inner + light(radius + kSidePx)) / 2;
  double best = radius, best_off_px = kSidePx;
  for (double r = radius - kSidePx; r < radius + kSidePx; r += kStepPx) {
    const double here = light(r) - middle, next = light(r + kStepPx) - middle;
    if (here * next > 0 || here == next) continue;
    const double crossing = r + kStepPx * here / (here - next);
    if (std::abs(crossing - radius) >= best_off_px) continue;
    best_off_px = std::abs(crossing - radius);
    best = crossing;
  }
  return best;
}

/// The edges that cross a circle's radii, `reach` of the radius inwards and outwards.
std::vector<glm::dvec2> edge_points(const cv::Mat& log_picture, const BallCircle& circle, double reach) {
  constexpr int kRadii = 360;
  const double reach_px = std::max(3.0, reach * circle.radius_px);
  std::vector<glm::dvec2> points;
  for (int i = 0; i < kRadii; ++i) {
    const glm::dvec2 outward(std::cos(2 * kPi * i / kRadii), std::sin(2 * kPi * i / kRadii));
    for (const double radius : edge_radii(log_picture, circle, outward, reach_px)) {
      const glm::dvec2 point = circle.centre_px + refined_radius(log_picture, circle.centre_px, outward, radius) * outward;
      if (point.x > 1 && point.y > 1 && point.x < log_picture.cols - 2 && point.y < log_picture.rows - 2) points.push_back(point);
    }
  }
  return points;
}

/// The points in a projection that shows the silhouette as a circle: stereographic about the camera's axis, which keeps circular
/// cones circles; unchanged where the camera is far away.
std::vector<glm::dvec2> as_circle(const std::vector<glm::dvec2>& points_px, const std::optional<CameraModel>& camera) {
  if (!camera) return points_px;
  std::vector<glm::dvec2> flat;
  for (const glm::dvec2& px : points_px) {
    const glm::dvec3 ray = ray_through(*camera, px);
    flat.push_back(2 * std::sqrt(camera->fx_px * camera->fy_px) * glm::dvec2(ray) / (1 + ray.z));
  }
  return flat;
}

/// Those of the points that agree with the circle that most agree on (Fischler & Bolles 1981): reflections near the rim have
/// edges too.
std::vector<glm::dvec2> agreeing(const std::vector<glm::dvec2>& points_px, const std::optional<CameraModel>& camera,
                                 double tolerance_px) {
  constexpr int kTries = 1500;
  const std::vector<glm::dvec2> flat = as_circle(points_px, camera);
  std::vector<glm::dvec2> best;
  cv::RNG random(1);
  for (int i = 0; i < kTries && flat.size() >= 3; ++i) {
    const int count = static_cast<int>(flat.size()), first = random.uniform(0, count);
    // Three points about a third of the way round from each other, as narrow triples tell little.
    const auto corner = [&](int k) { return flat[(first + k * count / 3 + random.uniform(0, count / 6 + 1)) % count]; };
    const BallCircle circle = fit_circle({corner(0), corner(1), corner(2)});
    std::vector<glm::dvec2> near;
    for (int k = 0; k < count; ++k)
      if (std::abs(glm::distance(flat[k], circle.centre_px) - circle.radius_px) < tolerance_px) near.push_back(points_px[k]);
    if (near.size() > best.size()) best = std::move(near);
  }
  return best;
}

}  // namespace

std::vector<glm::dvec2> find_ball_outline(const Image& radiance, const std::optional<CameraModel>& camera,
                                          const std::string& what) {
  constexpr std::size_t kMinPoints = 120;  // a third of the 360 radii
  const cv::Mat log_picture = log_luminance(radiance);
  std::vector<glm::dvec2> best;
  double longest_px = 0;  // what a ball reflects may be round too, but is smaller
  for (const BallCircle& candidate : candidates(log_picture)) {
    const double radius_px = candidate.radius_px;
    std::vector<glm::dvec2> points = agreeing(edge_points(log_picture, candidate, 0.12), camera, 0.003 * radius_px + 0.5);
    if (points.size() < kMinPoints) continue;
    points = agreeing(edge_points(log_picture, fit_circle(points), 0.04), camera, 0.001 * radius_px + 0.3);
    const double length_px = points.size() < kMinPoints ? 0 : static_cast<double>(points.size()) * fit_circle(points).radius_px;
    if (length_px <= longest_px) continue;
    best = std::move(points);
    longest_px = length_px;
  }
  if (best.empty()) throw Error(what + ": no mirror ball was found; give it with --ball X,Y,RADIUS in pixels");
  return best;
}

}  // namespace catchlight::app
