#include "app/tools/probe_merge/orientation.hpp"

#include <algorithm>
#include <cmath>

#include "app/session/absent_tag.hpp"
#include "catchlight/color.hpp"
#include "catchlight/track.hpp"
#include "tracking/observation.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::app {
namespace {

double luminance(const float* rgb) {
  return glm::dot(kLuminanceWeights, glm::dvec3(rgb[0], rgb[1], rgb[2]));
}

double median_luminance(const Image& radiance) {
  std::vector<double> values;
  for (int y = 0; y < radiance.height; ++y)
    for (int x = 0; x < radiance.width; ++x) values.push_back(luminance(radiance.pixel(x, y)));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<std::uint8_t> exposed(const Image& radiance, double exposure) {
  std::vector<std::uint8_t> codes;
  codes.reserve(static_cast<std::size_t>(radiance.width) * radiance.height);
  for (int y = 0; y < radiance.height; ++y)
    for (int x = 0; x < radiance.width; ++x) {
      const double code = srgb_from_linear(std::min(1.0, exposure * luminance(radiance.pixel(x, y))));
      codes.push_back(static_cast<std::uint8_t>(std::lround(255 * code)));
    }
  return codes;
}

}  // namespace

std::optional<TagSight> find_tag(const Image& radiance, const CameraModel& camera, const TagTarget& target) {
  const double median = median_luminance(radiance);
  if (!(median > 0)) return std::nullopt;
  std::optional<TagSight> best;
  for (const double ev : {0.0, -2.0, 2.0, -4.0, 4.0}) {
    const std::vector<std::uint8_t> codes = exposed(radiance, 0.25 * std::exp2(ev) / median);
    tracking::Tracker tracker(camera, target);
    const tracking::TagObservation seen = tracker.track({codes.data(), radiance.width, radiance.height, radiance.width}, 0);
    if (seen.state != TrackState::tracking) continue;
    if (!best || seen.corner_sigma_px < best->corner_sigma_px)
      best = TagSight{seen.camera_from_tag, seen.corner_sigma_px, seen.ambiguity};
  }
  return best;
}

std::string instead_of_tag(const Image& radiance, const TagTarget& target) {
  const std::vector<std::uint8_t> codes = exposed(radiance, 0.25 / std::max(median_luminance(radiance), 1e-20));
  return what_is_there(target, {{codes.data(), radiance.width, radiance.height, radiance.width}});
}

glm::dmat3 probe_from_camera(double yaw_deg, double pitch_deg) {
  const double yaw = glm::radians(yaw_deg), pitch = glm::radians(pitch_deg);
  // Columns: where the camera's x (right), y (down) and z (forward) go for a camera at +z that looks down by pitch.
  const glm::dmat3 pitched(glm::dvec3(1, 0, 0), glm::dvec3(0, -std::cos(pitch), std::sin(pitch)),
                           glm::dvec3(0, -std::sin(pitch), -std::cos(pitch)));
  const glm::dmat3 turned(glm::dvec3(std::cos(yaw), 0, -std::sin(yaw)), glm::dvec3(0, 1, 0),
                          glm::dvec3(std::sin(yaw), 0, std::cos(yaw)));
  return turned * pitched;
}

}  // namespace catchlight::app
