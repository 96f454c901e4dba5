#include "app/tools/probe_merge/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "catchlight/color.hpp"
#include "catchlight/image.hpp"
#include "catchlight/util/parallel.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::app {
namespace {

constexpr double kPi = std::numbers::pi;

glm::dvec3 radiance_at(const Image& image, const glm::dvec2& px) {
  const double column = std::clamp(px.x, 0.0, image.width - 1.0), row = std::clamp(px.y, 0.0, image.height - 1.0);
  const int x = std::min(static_cast<int>(column), image.width - 2), y = std::min(static_cast<int>(row), image.height - 2);
  const auto pixel = [&](int dx, int dy) {
    const float* rgb = image.pixel(x + dx, y + dy);
    return glm::dvec3(rgb[0], rgb[1], rgb[2]);
  };
  return glm::mix(glm::mix(pixel(0, 0), pixel(1, 0), column - x), glm::mix(pixel(0, 1), pixel(1, 1), column - x), row - y);
}

bool is_clipped_at(const RadianceMap& map, const glm::dvec2& px) {
  const auto x = static_cast<std::size_t>(std::clamp<long>(std::lround(px.x), 0, map.image.width - 1));
  const auto y = static_cast<std::size_t>(std::clamp<long>(std::lround(px.y), 0, map.image.height - 1));
  return map.clipped[y * map.image.width + x] != 0;
}

double away_from_photographer(const BallSight& sight, double photographer_rad) {
  const double t = std::clamp(sight.from_camera_rad / photographer_rad - 1, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// What all views together know of one direction.
struct Blend {
  glm::dvec3 radiance{0};
  double clipped = 0;  ///< weight share
  bool is_blind = true, is_photographer = true;
};

Blend blend(const std::vector<BallPicture>& views, const glm::dvec3& direction_probe, double photographer_rad) {
  Blend result;
  double weights = 0;
  for (const BallPicture& view : views) {
    const BallSight sight = view.ball.sight(glm::transpose(view.probe_from_camera) * direction_probe);
    const double weight = sight_weight(sight, photographer_rad);
    weights += weight;
    result.radiance += weight * view.gain * radiance_at(view.radiance.image, sight.px);
    if (is_clipped_at(view.radiance, sight.px)) result.clipped += weight;
    result.is_blind = result.is_blind && sight.is_behind;
    const bool is_clear = !sight.is_behind && away_from_photographer(sight, photographer_rad) > 0.5;
    result.is_photographer = result.is_photographer && !is_clear;
  }
  result.radiance /= weights;
  result.clipped /= weights;
  result.is_photographer = result.is_photographer && !result.is_blind;
  return result;
}

/// Sums over texels, in an order that does not depend on the threads.
struct Sums {
  double light = 0, clipped_light = 0, clipped_sr = 0, blind_sr = 0, photographer_sr = 0;

  void add(const Blend& blend, double solid_angle_sr) {
    const double light_here = solid_angle_sr * glm::dot(kLuminanceWeights, blend.radiance);
    light += light_here;
    clipped_light += blend.clipped * light_here;
    clipped_sr += blend.clipped * solid_angle_sr;
    blind_sr += blend.is_blind ? solid_angle_sr : 0;
    photographer_sr += blend.is_photographer ? solid_angle_sr : 0;
  }
  void add(const Sums& other) {
    light += other.light;
    clipped_light += other.clipped_light;
    clipped_sr += other.clipped_sr;
    blind_sr += other.blind_sr;
    photographer_sr += other.photographer_sr;
  }
};

}  // namespace

double sight_weight(const BallSight& sight, double photographer_rad) {
  constexpr double kRim = 1e-3, kPhotographer = 1e-6, kHidden = 1e-12;
  if (sight.is_behind) return kHidden;
  return (kPhotographer + away_from_photographer(sight, photographer_rad)) * (kRim + 1 - sight.rim * sight.rim);
}

double gain_between(const BallPicture& reference, const BallPicture& other, double photographer_rad) {
  constexpr int kHeight = 64;
  constexpr double kSeenWell = 0.2;
  std::vector<double> ratios;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < 2 * kHeight; ++x) {
      const glm::dvec3 direction = *render::direction_from_texel(render::ProbeLayout::latlong, 2 * kHeight, kHeight, x, y);
      double luminance[2] = {};
      bool is_seen = true;
      for (const int i : {0, 1}) {
        const BallPicture& view = i == 0 ? reference : other;
        const BallSight sight = view.ball.sight(glm::transpose(view.probe_from_camera) * direction);
        luminance[i] = glm::dot(kLuminanceWeights, radiance_at(view.radiance.image, sight.px));
        is_seen = is_seen && luminance[i] > 0 && sight_weight(sight, photographer_rad) > kSeenWell &&
                  !is_clipped_at(view.radiance, sight.px);
      }
      if (is_seen) ratios.push_back(luminance[0] / luminance[1]);
    }
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

AssembledProbe assemble_probe(const std::vector<BallPicture>& views, int width, double photographer_rad) {
  const int height = (width + 1) / 2;
  AssembledProbe result{{Image(width, height), render::ProbeLayout::latlong}, 0, 0, 0, 0};
  std::vector<Sums> rows(height);
  parallel_for(height, 0, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const double solid_angle_sr = render::texel_solid_angle(render::ProbeLayout::latlong, width, height, x, y);
      for (const glm::dvec2& tap : {glm::dvec2(-0.25, -0.25), {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}}) {
        const auto direction = render::direction_from_texel(render::ProbeLayout::latlong, width, height, x + tap.x, y + tap.y);
        const Blend seen = blend(views, *direction, photographer_rad);
        rows[row].add(seen, solid_angle_sr / 4);
        for (int c = 0; c < 3; ++c) result.probe.image.pixel(x, y)[c] += static_cast<float>(seen.radiance[c] / 4);
      }
    }
  });
  render::weld_seams(result.probe);
  Sums sums;
  for (const Sums& row : rows) sums.add(row);
  result.blind_share = sums.blind_sr / (4 * kPi);
  result.photographer_share = sums.photographer_sr / (4 * kPi);
  result.clipped_sr = sums.clipped_sr;
  result.clipped_light = sums.light > 0 ? sums.clipped_light / sums.light : 0;
  return result;
}

}  // namespace catchlight::app
