#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "render/probe/probe.hpp"

namespace catchlight::render {
namespace {

// Texels of one direction share one key; those 1e-6 apart do not occur in images of up to 32768 texels a side.
std::tuple<long, long, long> key_of(const glm::dvec3& direction) {
  return {std::lround(direction.x * 1e6), std::lround(direction.y * 1e6), std::lround(direction.z * 1e6)};
}

std::vector<glm::ivec2> texels_on_seams(const Probe& probe) {
  const int width = probe.image.width, height = probe.image.height;
  const int side = probe.layout == ProbeLayout::latlong ? height : width;  // a cube's faces are stacked squares
  std::vector<glm::ivec2> texels;
  for (int y = 0; y < height; ++y) {
    const bool whole_row = y % side == 0 || y % side == side - 1;
    for (int x = 0; x < width; x += whole_row ? 1 : width - 1) texels.emplace_back(x, y);
  }
  return texels;
}

}  // namespace

void weld_seams(Probe& probe) {
  if (probe.layout != ProbeLayout::latlong && probe.layout != ProbeLayout::cube) return;
  struct Sum {
    glm::dvec3 light{0};
    double weight = 0;
  };
  std::map<std::tuple<long, long, long>, Sum> sums;
  const int width = probe.image.width, height = probe.image.height;
  const auto sum_at = [&](const glm::ivec2& at) -> Sum& {
    return sums[key_of(*direction_from_texel(probe.layout, width, height, at.x, at.y))];
  };
  const std::vector<glm::ivec2> texels = texels_on_seams(probe);
  for (const glm::ivec2& at : texels) {
    const float* value = probe.image.pixel(at.x, at.y);
    const double weight = texel_solid_angle(probe.layout, width, height, at.x, at.y);
    Sum& sum = sum_at(at);
    sum.light += weight * glm::dvec3(value[0], value[1], value[2]);
    sum.weight += weight;
  }
  for (const glm::ivec2& at : texels) {
    const Sum& sum = sum_at(at);
    for (int c = 0; c < 3; ++c) probe.image.pixel(at.x, at.y)[c] = static_cast<float>(sum.light[c] / sum.weight);
  }
}

}  // namespace catchlight::render
