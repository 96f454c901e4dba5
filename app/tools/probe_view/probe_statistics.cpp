#include "app/tools/probe_view/probe_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/color.hpp"

namespace catchlight::app {
namespace {

constexpr int kSamplesAcross = 4;  ///< samples along a side of a preview's pixel

double luminance(const float* rgb) {
  return glm::dot(kLuminanceWeights, glm::dvec3(rgb[0], rgb[1], rgb[2]));
}

/// visit(x, y, luminance, solid angle) for each texel that stands for a direction.
template <class Visit>
void for_each_texel(const render::Probe& probe, Visit visit) {
  const Image& image = probe.image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double solid_angle_sr = render::texel_solid_angle(probe.layout, image.width, image.height, x, y);
      if (solid_angle_sr > 0) visit(x, y, luminance(image.pixel(x, y)), solid_angle_sr);
    }
}

std::vector<double> band_energies(const render::Probe& probe, int bands) {
  const render::ShRgb coefficients = render::project_to_sh(probe, bands);
  std::vector<double> energies;
  for (int l = 0; l < bands; ++l) {
    double energy = 0;
    for (int m = -l; m <= l; ++m) {
      const double value =
          glm::dot(kLuminanceWeights, glm::dvec3(coefficients[static_cast<std::size_t>(render::sh_index(l, m))]));
      energy += value * value;
    }
    energies.push_back(energy);
  }
  return energies;
}

}  // namespace

ProbeStatistics measure_probe(const render::Probe& probe, int bands) {
  ProbeStatistics result;
  double solid_angle_sum = 0;
  for_each_texel(probe, [&](int x, int y, double value, double solid_angle_sr) {
    solid_angle_sum += solid_angle_sr;
    result.mean += value * solid_angle_sr;
    result.energy += value * value * solid_angle_sr;
    if (value > 0 && (result.min_lit == 0 || value < result.min_lit)) result.min_lit = value;
    if (value <= result.max) return;
    result.max = value;
    result.brightest = render::direction_from_texel(probe.layout, probe.image.width, probe.image.height, x, y).value();
  });
  result.mean /= solid_angle_sum;
  if (result.max > 0) {
    double log_sum = 0;
    for_each_texel(probe, [&](int, int, double value, double solid_angle_sr) {
      log_sum += std::log(1e-6 * result.max + value) * solid_angle_sr;
    });
    result.log_average = std::exp(log_sum / solid_angle_sum);
    result.range_ev = std::log2(result.max / result.min_lit);
  }
  result.irradiance_up = render::irradiance(probe, {0, 1, 0});
  result.irradiance_down = render::irradiance(probe, {0, -1, 0});
  result.band_energy = band_energies(probe, bands);
  return result;
}

Image mirror_ball_preview(const render::Probe& probe, double yaw_deg, int size_px) {
  const glm::dmat3 probe_from_tag = glm::transpose(render::tag_from_probe(render::UpAxis::z, yaw_deg));
  const double step = 2.0 / (size_px * kSamplesAcross);
  const auto ball_radiance = [&](int column, int row) -> glm::vec4 {
    const double right = (column + 0.5) * step - 1, up = 1 - (row + 0.5) * step;
    const double depth_squared = 1 - right * right - up * up;
    if (depth_squared <= 0) return glm::vec4(0);
    const double towards_camera = std::sqrt(depth_squared);
    const glm::dvec3 normal(right, -towards_camera, up), view(0, 1, 0);
    return {render::sample(probe, probe_from_tag * glm::reflect(view, normal)), 1.0f};
  };
  Image image(size_px, size_px, 4);
  for (int y = 0; y < size_px; ++y)
    for (int x = 0; x < size_px; ++x) {
      glm::vec4 sum(0);
      for (int i = 0; i < kSamplesAcross * kSamplesAcross; ++i)
        sum += ball_radiance(x * kSamplesAcross + i % kSamplesAcross, y * kSamplesAcross + i / kSamplesAcross);
      for (int c = 0; c < 4; ++c) image.pixel(x, y)[c] = sum[c] / (kSamplesAcross * kSamplesAcross);
    }
  return image;
}

}  // namespace catchlight::app
