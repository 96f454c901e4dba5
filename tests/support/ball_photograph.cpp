#include "tests/support/ball_photograph.hpp"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "tests/support/synthetic_tag.hpp"

namespace catchlight::tests {
namespace {

constexpr int kRaysAcross = 4;  ///< rays along a side of a pixel
constexpr double kSurround = 0.3;

/// A lobe of a von Mises-Fisher's shape: 1 in its middle.
double lobe(const glm::dvec3& direction, const glm::dvec3& middle, double width_rad) {
  return std::exp((glm::dot(direction, glm::normalize(middle)) - 1) / (width_rad * width_rad));
}

/// Distance along a unit ray from the origin to a sphere, as solved for in any textbook.
std::optional<double> sphere_hit(const glm::dvec3& ray, const glm::dvec3& centre, double radius) {
  const double along = glm::dot(ray, centre), inside = along * along - glm::dot(centre, centre) + radius * radius;
  if (inside < 0) return std::nullopt;
  return along - std::sqrt(inside);
}

Image surroundings(const BallScene& scene) {
  Image image(scene.camera.width_px, scene.camera.height_px);
  std::fill(image.data.begin(), image.data.end(), static_cast<float>(kSurround));
  if (!scene.camera_from_tag) return image;
  tracking::SyntheticScene printed{scene.camera, {{scene.tag, *scene.camera_from_tag}}};
  printed.background_linear = kSurround;
  const tracking::SyntheticFrame frame = tracking::render(printed);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = frame.linear[i / 3];
  return image;
}

}  // namespace

glm::dvec3 room(const glm::dvec3& d) {
  const double sky = 0.5 + 0.5 * d.y;
  glm::dvec3 light = glm::mix(glm::dvec3(0.05, 0.045, 0.04), glm::dvec3(0.5, 0.55, 0.6), sky * sky);
  light += 12.0 * lobe(d, {1, 0.5, 0.3}, 0.25) * glm::dvec3(1.0, 0.8, 0.5);
  light += 6.0 * lobe(d, {-0.7, 0.2, -1}, 0.35) * glm::dvec3(0.4, 0.6, 1.0);
  light += 200.0 * lobe(d, {-0.5, 1, 0.6}, 0.06) * glm::dvec3(1.0, 0.95, 0.9);
  return light;
}

CameraModel ball_camera() {
  CameraModel camera;
  camera.width_px = 800;
  camera.height_px = 600;
  camera.fx_px = camera.fy_px = 1000;
  camera.cx_px = 399.5;
  camera.cy_px = 299.5;
  return camera;
}

Image photograph(const BallScene& scene) {
  Image image = surroundings(scene);
  const CameraModel& camera = scene.camera;
  const glm::dvec3 towards_camera = -glm::normalize(scene.centre_camera_m);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      glm::dvec3 sum(0);
      int hits = 0;
      for (int i = 0; i < kRaysAcross * kRaysAcross; ++i) {
        const double px = x - 0.5 + (i % kRaysAcross + 0.5) / kRaysAcross, py = y - 0.5 + (i / kRaysAcross + 0.5) / kRaysAcross;
        const glm::dvec3 ray =
            glm::normalize(glm::dvec3((px - camera.cx_px) / camera.fx_px, (py - camera.cy_px) / camera.fy_px, 1));
        const auto distance = sphere_hit(ray, scene.centre_camera_m, scene.radius_m);
        if (!distance) continue;
        ++hits;
        const glm::dvec3 normal = (*distance * ray - scene.centre_camera_m) / scene.radius_m;
        const glm::dvec3 mirrored = ray - 2 * glm::dot(ray, normal) * normal;
        const bool is_person = std::acos(glm::dot(mirrored, towards_camera)) < scene.photographer_rad;
        sum += is_person ? glm::dvec3(3, 0, 3) : scene.environment(scene.probe_from_camera * mirrored);
      }
      const double rays = kRaysAcross * kRaysAcross;
      for (int c = 0; c < 3; ++c) {
        float& value = image.pixel(x, y)[c];
        value = static_cast<float>((value * (rays - hits) + sum[c]) / rays);
      }
    }
  return image;
}

double film_code(double light) {
  const double x = std::pow(std::clamp(light, 0.0, 1.0), 0.5);
  return x * (1 + 0.25 * (1 - x) * (x - 0.2));
}

double film_light(double code) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (film_code(middle) < code ? low : high) = middle;
  }
  return low;
}

std::vector<std::string> write_bracket(const Image& radiance, const std::vector<double>& times_s, double noise_codes,
                                       const std::string& name_start) {
  std::vector<std::string> names;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, noise_codes);
  for (const double time_s : times_s) {
    cv::Mat codes(radiance.height, radiance.width, CV_8UC3);
    for (int y = 0; y < codes.rows; ++y)
      for (int x = 0; x < codes.cols; ++x)
        for (int c = 0; c < 3; ++c) {
          const double code = 255 * film_code(radiance.pixel(x, y)[c] * time_s);
          codes.at<cv::Vec3b>(y, x)[2 - c] =
              static_cast<std::uint8_t>(std::clamp(std::lround(code + (noise_codes > 0 ? noise(random) : 0)), 0l, 255l));
        }
    names.push_back(name_start + std::to_string(names.size()) + ".png");
    cv::imwrite(names.back(), codes);
  }
  return names;
}

}  // namespace catchlight::tests
