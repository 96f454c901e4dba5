#include "app/photometry/exposure.hpp"

#include <cmath>

namespace catchlight::app {

TagReading read_exposure(const tracking::TagPhotometry& photometry, double white_albedo, double black_albedo) {
  TagReading reading;
  for (int c = 0; c < 3; ++c) {
    const double white_cell = photometry.white_linear[c], black_cell = photometry.black_linear[c];
    double white = (white_cell - black_cell) / (white_albedo - black_albedo);
    double black = black_cell - white * black_albedo;
    ExposureSource source = ExposureSource::tag;
    if (photometry.is_clipped[c]) {
      white = black_albedo > 0 ? black_cell / black_albedo : 0;
      black = 0;
      source = ExposureSource::black;
    } else if (black < 0) {  // blacks crushed by the camera: only the white cells still tell the gain
      white = white_cell / white_albedo;
      black = 0;
    }
    if (!(white > 0)) continue;
    reading.exposure.white[c] = white;
    reading.exposure.black[c] = black;
    reading.sources[static_cast<std::size_t>(c)] = source;
  }
  return reading;
}

glm::dvec3 exposure_gain(const SceneSettings::Exposure& settings, const glm::dvec3& white,
                         const glm::dvec3& tag_irradiance_over_pi) {
  const double stops = std::exp2(settings.ev);
  if (settings.mode == "fixed") return glm::dvec3(stops);
  glm::dvec3 gain(0.0);  // a channel in which the probe is black stays black
  for (int c = 0; c < 3; ++c)
    if (tag_irradiance_over_pi[c] > 1e-12) gain[c] = stops * white[c] / tag_irradiance_over_pi[c];
  return gain;
}

}  // namespace catchlight::app
