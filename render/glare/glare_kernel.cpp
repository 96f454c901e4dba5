#include "render/glare/glare_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/glare/spline_samples.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
namespace {

double gaussian(double x, double sigma) {
  return std::exp(-x * x / (2 * sigma * sigma)) / (sigma * std::sqrt(glm::two_pi<double>()));
}

/// l exp(-l u), u > 0, convolved with a Gaussian ("exponentially modified Gaussian distribution").
double smoothed_exponential(double u, double l, double sigma) {
  const double z = (l * sigma * sigma - u) / (std::sqrt(2.0) * sigma);
  if (z < 5) return 0.5 * l * std::exp(0.5 * l * (l * sigma * sigma - 2 * u)) * std::erfc(z);
  // There exp() overflows and erfc() vanishes: their product by erfc's asymptotic series.
  return 0.5 * l * std::exp(-u * u / (2 * sigma * sigma)) / (z * std::sqrt(glm::pi<double>())) * (1 - 0.5 / (z * z));
}

/// One axis of each Gaussian of the bloom, at each pixel.
std::vector<std::array<double, kBloomGaussians>> bloom_axis(double frame_height_px, int size) {
  std::vector<std::array<double, kBloomGaussians>> axis(static_cast<std::size_t>(size));
  const auto gaussians = bloom_gaussians();
  for (int i = 0; i < size; ++i) {
    for (std::size_t g = 0; g < kBloomGaussians; ++g)
      axis[static_cast<std::size_t>(i)][g] = gaussian(i - size / 2, gaussians[g].sigma_heights * frame_height_px);
  }
  return axis;
}

}  // namespace

Image glare_kernel(const GlareSettings& settings, double frame_height_px, int width, int height) {
  Image kernel(width, height, 3);
  const auto across = bloom_axis(frame_height_px, width), down = bloom_axis(frame_height_px, height);
  const auto gaussians = bloom_gaussians();
  const glm::dvec3 l = -streak_log_per_height(settings) / frame_height_px;
  const double sigma = settings.streak_width * frame_height_px;
  const auto directions = streak_directions(settings.streak_directions, settings.streak_rotation_deg);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      glm::dvec3 value(0);
      for (std::size_t g = 0; g < kBloomGaussians; ++g) {
        value += settings.bloom_strength * gaussians[g].weight * across[static_cast<std::size_t>(x)][g] *
                 down[static_cast<std::size_t>(y)][g];
      }
      const glm::dvec2 from_middle(x - width / 2, y - height / 2);
      for (const glm::dvec2& direction : directions) {
        const double u = glm::dot(from_middle, direction), v = from_middle.y * direction.x - from_middle.x * direction.y;
        if (std::abs(v) > 8 * sigma || u < -8 * sigma) continue;
        const double share = settings.streak_strength / settings.streak_directions * gaussian(v, sigma);
        for (int c = 0; c < 3; ++c) value[c] += share * smoothed_exponential(u, l[c], sigma);
      }
      for (int c = 0; c < 3; ++c) kernel.pixel(x, y)[c] = static_cast<float>(value[c]);
    }
  }
  return kernel;
}

Image at_frame_pixels(const Image& grid_picture, const GlareGrid& grid, int frame_width, int frame_height) {
  const auto spline = [&](int pixel) { return spline_at((pixel + 0.5) / grid.texel_px + GLARE_MARGIN); };
  const auto row_of = [&](int y) { return std::clamp(y, 0, grid_picture.height - 1); };
  Image rows(grid_picture.width, frame_height, 3), result(frame_width, frame_height, 3);
  for (int y = 0; y < frame_height; ++y) {
    const SplineSamples samples = spline(y);
    for (int i = 0; i < 4; ++i) {
      const float* from = grid_picture.pixel(0, row_of(samples.first + i));
      for (int k = 0; k < 3 * rows.width; ++k) rows.pixel(0, y)[k] += samples.weights[static_cast<std::size_t>(i)] * from[k];
    }
  }
  for (int x = 0; x < frame_width; ++x) {
    const SplineSamples samples = spline(x);
    for (int y = 0; y < frame_height; ++y) {
      for (int i = 0; i < 4; ++i) {
        const float* from = rows.pixel(std::clamp(samples.first + i, 0, rows.width - 1), y);
        for (int c = 0; c < 3; ++c) result.pixel(x, y)[c] += samples.weights[static_cast<std::size_t>(i)] * from[c];
      }
    }
  }
  return result;
}

}  // namespace catchlight::render
