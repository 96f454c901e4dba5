#include "tracking/camera/plane_light.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catchlight/projection.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kPatchesAcross = 10, kPatchesPerTag = 2;
constexpr std::size_t kPatches = kPatchesAcross * kPatchesAcross - kPatchesPerTag * kPatchesPerTag;  ///< the last places
constexpr double kClippedShare = 0.02;  ///< more clipped samples of a place would pull its mean

/// A square on the plane, in sides of the tag from its centre, x right and y up.
struct Place {
  glm::dvec2 low;
  double side;
  int samples_across;
};

/// The places on the tag are the middles of cells alone: edges are blurred into each other.
std::vector<Place> places_of(const TagTarget& target) {
  constexpr int kCellSamples = 8, kPatchSamples = 12;
  std::vector<Place> places;
  const int cells = tag_layout(target.family, target.id).cells_across;
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column)
      places.push_back({(glm::dvec2(column, row) + 0.25) / static_cast<double>(cells) - 0.5, 0.5 / cells, kCellSamples});
  constexpr double kSide = 1.0 / kPatchesPerTag;
  for (int row = 0; row < kPatchesAcross; ++row)
    for (int column = 0; column < kPatchesAcross; ++column) {
      const glm::dvec2 low = (glm::dvec2(column, row) - kPatchesAcross / 2.0) * kSide;
      const glm::dvec2 middle = glm::abs(low + kSide / 2);
      if (std::max(middle.x, middle.y) > 0.5) places.push_back({low, kSide, kPatchSamples});
    }
  return places;
}

struct Ratio {
  double value, weight;
};

/// The ratios of the first `places`, as far as they are known in both.
std::vector<Ratio> ratios_of(const PlaneLight& now, const PlaneLight& then, int channel, std::size_t places) {
  constexpr float kMinLinear = 1e-3f;  // a quarter of a code of 8 bits in sRGB: darker places say nothing
  std::vector<Ratio> ratios;
  for (std::size_t i = 0; i < std::min({places, now.linear.size(), then.linear.size()}); ++i) {
    const float bright = now.linear[i][channel], before = then.linear[i][channel];
    if (!(bright > kMinLinear && before > kMinLinear)) continue;
    ratios.push_back({static_cast<double>(bright) / static_cast<double>(before),
                      static_cast<double>(std::min(now.samples[i], then.samples[i]) * before)});
  }
  return ratios;
}

struct MiddleHalf {
  double low, mean, high;
};

/// The half in the middle of all weights, laid end to end.
std::optional<MiddleHalf> middle_half(std::vector<Ratio> ratios) {
  constexpr std::size_t kMinPlaces = 8;
  if (ratios.size() < kMinPlaces) return std::nullopt;
  std::sort(ratios.begin(), ratios.end(), [](const Ratio& a, const Ratio& b) { return a.value < b.value; });
  double whole = 0, at = 0, sum = 0;
  for (const Ratio& ratio : ratios) whole += ratio.weight;
  MiddleHalf half{0, 0, 0};
  for (const Ratio& ratio : ratios) {
    const double inside = std::min(at + ratio.weight, 0.75 * whole) - std::max(at, 0.25 * whole);
    at += ratio.weight;
    if (!(inside > 0)) continue;
    if (sum == 0) half.low = ratio.value;
    half.high = ratio.value;
    sum += inside * ratio.value;
  }
  half.mean = sum / (0.5 * whole);
  return half;
}

}  // namespace

PlaneLight measure_plane(const PixelLight& light, const CameraModel& camera, const RigidTransform& camera_from_tag,
                         const TagTarget& target) {
  PlaneLight plane;
  for (const Place& place : places_of(target)) {
    const PlaneSquare square{target.size_m * place.low, target.size_m * place.side};
    const auto seen = square_light(light, camera, camera_from_tag, square, place.samples_across);
    glm::vec3 linear(std::numeric_limits<float>::quiet_NaN());
    for (int c = 0; c < 3; ++c)
      if (seen && seen->clipped[c] <= kClippedShare * seen->samples) linear[c] = static_cast<float>(seen->mean[c]);
    plane.linear.push_back(linear);
    plane.samples.push_back(static_cast<float>(place.samples_across * place.samples_across));
  }
  return plane;
}

std::optional<double> brightening(const PlaneLight& now, const PlaneLight& then, int channel) {
  constexpr double kMaxSpread = 1.05;  // a still surface: 1.02 through H.264; another one: 1.1 and far more
  const auto all = middle_half(ratios_of(now, then, channel, now.linear.size()));
  if (all && all->high <= kMaxSpread * all->low) return all->mean;
  const std::size_t tag_cells = now.linear.size() - std::min(now.linear.size(), kPatches);
  const auto cells = middle_half(ratios_of(now, then, channel, tag_cells));
  return cells ? std::optional(cells->mean) : std::nullopt;
}

}  // namespace catchlight::tracking
