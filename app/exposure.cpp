#include "app/exposure.hpp"

#include <cmath>

namespace catchlight::app {

TagExposure ExposureMatcher::update(const std::optional<tracking::TagPhotometry>& photometry) {
  if (!photometry) return current_;
  TagExposure next;
  for (int c = 0; c < 3; ++c) {
    const double white_cell = photometry->white_linear[c], black_cell = photometry->black_linear[c];
    next.white[c] = (white_cell - black_cell) / (white_albedo_ - black_albedo_);
    next.black[c] = black_cell - next.white[c] * black_albedo_;
    if (next.black[c] < 0) {  // blacks crushed by the camera: only the white cells still tell the gain
      next.black[c] = 0;
      next.white[c] = white_cell / white_albedo_;
    }
    if (!(next.white[c] > 0)) return current_;
  }
  current_ = next;
  return current_;
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
