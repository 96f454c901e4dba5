#include "app/exposure.hpp"

#include <cmath>

namespace catchlight::app {

MatchedExposure ExposureMatcher::update(const std::optional<tracking::TagPhotometry>& photometry, const glm::dvec3& brightening) {
  MatchedExposure matched;
  for (int c = 0; photometry && c < 3; ++c)
    matched.sources[static_cast<std::size_t>(c)] = update_channel(*photometry, brightening[c], c);
  matched.exposure = current_;
  return matched;
}

ExposureSource ExposureMatcher::update_channel(const tracking::TagPhotometry& photometry, double brightening, int channel) {
  const double white_cell = photometry.white_linear[channel], black_cell = photometry.black_linear[channel];
  double& white = current_.white[channel];
  double& black = current_.black[channel];
  if (photometry.is_clipped[channel]) {
    if (is_measured_[channel] && brightening > 0) {
      white = measured_.white[channel] * brightening;
      black = measured_.black[channel] * brightening;  // flare is light, too
      return ExposureSource::surface;
    }
    if (is_measured_[channel] || !(black_cell > 0 && black_albedo_ > 0)) return ExposureSource::held;
    white = black_cell / black_albedo_;
    black = 0;
    return ExposureSource::black;
  }
  double gain = (white_cell - black_cell) / (white_albedo_ - black_albedo_);
  double flare = black_cell - gain * black_albedo_;
  if (flare < 0) {  // blacks crushed by the camera: only the white cells still tell the gain
    flare = 0;
    gain = white_cell / white_albedo_;
  }
  if (!(gain > 0)) return ExposureSource::held;
  white = measured_.white[channel] = gain;
  black = measured_.black[channel] = flare;
  is_measured_[channel] = true;
  return ExposureSource::tag;
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
