#include "app/tools/probe_view/mirror_ball.hpp"

#include <cmath>

namespace catchlight::app {

Image mirror_ball(const render::Probe& probe, const glm::dmat3& probe_from_ball, int size_px, int samples_across) {
  const double step = 2.0 / (size_px * samples_across);
  const auto ball_radiance = [&](int column, int row) -> glm::vec4 {
    const double right = (column + 0.5) * step - 1, up = 1 - (row + 0.5) * step;
    const double depth_squared = 1 - right * right - up * up;
    if (depth_squared <= 0) return glm::vec4(0);
    const double towards_camera = std::sqrt(depth_squared);
    const glm::dvec3 normal(right, -towards_camera, up), view(0, 1, 0);
    return {render::sample(probe, probe_from_ball * glm::reflect(view, normal)), 1.0f};
  };
  Image image(size_px, size_px, 4);
  const int count = samples_across * samples_across;
  for (int y = 0; y < size_px; ++y)
    for (int x = 0; x < size_px; ++x) {
      glm::vec4 sum(0);
      for (int i = 0; i < count; ++i)
        sum += ball_radiance(x * samples_across + i % samples_across, y * samples_across + i / samples_across);
      for (int c = 0; c < 4; ++c) image.pixel(x, y)[c] = sum[c] / static_cast<float>(count);
    }
  return image;
}

glm::dvec2 place_on_ball(const glm::dvec3& direction) {
  const glm::dvec3 halfway = direction + glm::dvec3(0, -1, 0);  // the normal lies between the light and the camera
  const double length = glm::length(halfway);
  return length > 1e-9 ? glm::dvec2(halfway.x, halfway.z) / length : glm::dvec2(0, 1);
}

Image mirror_ball_preview(const render::Probe& probe, double yaw_deg, int size_px) {
  constexpr int kSamplesAcross = 4;
  return mirror_ball(probe, glm::transpose(render::tag_from_probe(render::UpAxis::z, yaw_deg)), size_px, kSamplesAcross);
}

}  // namespace catchlight::app
