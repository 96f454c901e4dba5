#include "app/tools/probe_view/probe_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/color.hpp"

namespace catchlight::app {
namespace {

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

}  // namespace catchlight::app
