#include "render/probe/light_samples.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "catchlight/color.hpp"

namespace catchlight::render {
namespace {

double luminance_of(const LightPiece& piece) {
  return glm::dot(kLuminanceWeights, piece.irradiance);
}

// The middle of the flux. Pieces opposite each other have none: the first one's direction then.
glm::dvec3 middle_of(std::span<const LightPiece> region) {
  glm::dvec3 sum(0);
  for (const LightPiece& piece : region) sum += luminance_of(piece) * piece.direction;
  return glm::length(sum) > 0 ? glm::normalize(sum) : region.front().direction;
}

// The mean of (direction - middle)^2 along each axis of the frame.
glm::dvec3 variance(std::span<const LightPiece> region, const glm::dvec3& middle) {
  glm::dvec3 sum(0);
  double weight = 0;
  for (const LightPiece& piece : region) {
    const glm::dvec3 aside = piece.direction - middle;
    sum += luminance_of(piece) * aside * aside;
    weight += luminance_of(piece);
  }
  return weight > 0 ? sum / weight : glm::dvec3(0);
}

LightSample sample_of(std::span<const LightPiece> region) {
  LightSample sample{middle_of(region), glm::dvec3(0)};
  double weighted_square = 0, weight = 0;
  for (const LightPiece& piece : region) {
    const glm::dvec3 aside = piece.direction - sample.direction;
    // A piece is a square of its solid angle: a twelfth of that is its own variance.
    weighted_square += luminance_of(piece) * (glm::dot(aside, aside) / 2 + piece.solid_angle_sr / 12);
    weight += luminance_of(piece);
    sample.irradiance += piece.irradiance;
  }
  sample.spread_rad = weight > 0 ? std::sqrt(weighted_square / weight) : 0;
  return sample;
}

void cut(std::span<LightPiece> region, int count, std::vector<LightSample>& samples) {
  count = std::min(count, static_cast<int>(region.size()));
  if (count == 1) {
    samples.push_back(sample_of(region));
    return;
  }
  const glm::dvec3 spread = variance(region, middle_of(region));
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
  std::ranges::stable_sort(region, {}, [axis](const LightPiece& piece) { return piece.direction[axis]; });
  double total = 0, first_half = 0;
  for (const LightPiece& piece : region) total += luminance_of(piece);
  const int first_count = count / 2;
  std::size_t border = 0;
  while (border < region.size() && first_half + luminance_of(region[border]) / 2 < total * first_count / count)
    first_half += luminance_of(region[border++]);
  border = std::clamp<std::size_t>(border, 1, region.size() - 1);
  cut(region.first(border), first_count, samples);
  cut(region.subspan(border), count - first_count, samples);
}

}  // namespace

std::vector<LightSample> median_cut(std::vector<LightPiece> pieces, int count) {
  std::vector<LightSample> samples;
  cut(pieces, std::max(count, 1), samples);
  return samples;
}

ShRgb project_to_sh(std::span<const LightSample> samples, int bands) {
  std::vector<glm::dvec3> sum(sh_count(bands), glm::dvec3(0));
  std::vector<double> basis(sum.size());
  for (const LightSample& sample : samples) {
    evaluate_sh(sample.direction, bands, std::span<double>(basis));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += basis[i] * sample.irradiance;
  }
  return {sum.begin(), sum.end()};
}

}  // namespace catchlight::render
