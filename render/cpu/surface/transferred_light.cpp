#include "render/cpu/surface/transferred_light.hpp"

#include <algorithm>

#include "catchlight/util/parallel.hpp"

namespace catchlight::render {
namespace {

constexpr std::size_t kPointsAtOnce = 512;

glm::vec3 sum_of(std::span<const glm::vec3> transfer, const ShRgb& light) {
  glm::vec3 sum(0);
  for (std::size_t i = 0; i < light.size(); ++i) sum += light[i] * transfer[i];
  return sum;
}

}  // namespace

std::vector<glm::vec3> transferred_light(std::span<const glm::vec3> transfer, std::span<const glm::vec3> direct,
                                         const SplitLight& light) {
  const std::size_t count = light.whole.size(), points = transfer.size() / count;
  std::vector<glm::vec3> result(points);
  parallel_for((points + kPointsAtOnce - 1) / kPointsAtOnce, 0, [&](std::size_t chunk) {
    for (std::size_t p = chunk * kPointsAtOnce; p < std::min((chunk + 1) * kPointsAtOnce, points); ++p) {
      glm::vec3 sum = sum_of(transfer.subspan(p * count, count), light.whole);
      if (!light.split_off.empty()) sum -= sum_of(direct.subspan(p * count, count), light.split_off);
      // Few bands ring below zero around strong lights; light cannot. The comparison is false for NaN as well.
      for (int c = 0; c < 3; ++c) result[p][c] = sum[c] > 0 ? sum[c] : 0;
    }
  });
  return result;
}

}  // namespace catchlight::render
