#include "render/cpu/receiver/plane_lights.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "catchlight/util/parallel.hpp"

namespace catchlight::render {
namespace {

/// A bit a sample that is seen.
using Bits = std::array<std::uint64_t, 2>;

/// Texels from one node to the next.
constexpr int kCell = 4;
/// How far above the plane rays start, in shares of the object's diagonal.
constexpr float kLiftShare = 1.5f / 512;

class Plane {
 public:
  Plane(std::span<const LightSample> samples, const RayScene& rays, const Bounds& object)
      : rays_(rays), lift_m_(kLiftShare * object.rounded_diagonal_m()) {
    for (const LightSample& sample : samples) {
      if (!(sample.direction.z > 0)) continue;
      directions_.emplace_back(sample.direction);
      irradiances_over_pi_.emplace_back(sample.irradiance * (sample.direction.z / glm::pi<double>()));
    }
  }

  Bits all() const {
    Bits bits{};
    for (std::size_t i = 0; i < directions_.size(); ++i) bits[i / 64] |= std::uint64_t{1} << (i % 64);
    return bits;
  }

  glm::vec3 light_of(const Bits& seen) const {
    glm::vec3 sum(0);
    for_each(seen, [&](std::size_t sample) { sum += irradiances_over_pi_[sample]; });
    return sum;
  }

  /// Which of `asked` each place sees, into `seen`.
  void find_seen(std::span<const glm::vec2> places_m, const Bits& asked, std::span<Bits> seen) const {
    thread_local RayStream rays;
    thread_local std::vector<std::size_t> samples;
    samples.clear();
    for_each(asked, [&](std::size_t sample) { samples.push_back(sample); });
    rays.resize(samples.size() * places_m.size());
    std::ranges::fill(seen, Bits{});
    if (rays.size() == 0) return;
    for (std::size_t s = 0; s < samples.size(); ++s)
      for (std::size_t p = 0; p < places_m.size(); ++p)
        rays.set(s * places_m.size() + p, {places_m[p], lift_m_}, directions_[samples[s]], 0,
                 std::numeric_limits<float>::infinity());
    rays_.find_occluded(rays, Coherence::coherent);
    for (std::size_t s = 0; s < samples.size(); ++s)
      for (std::size_t p = 0; p < places_m.size(); ++p)
        if (!(rays.far[s * places_m.size() + p] < 0)) seen[p][samples[s] / 64] |= std::uint64_t{1} << (samples[s] % 64);
  }

 private:
  template <typename Visit>
  static void for_each(const Bits& bits, const Visit& visit) {
    for (std::size_t word = 0; word < 2; ++word)
      for (std::uint64_t rest = bits[word]; rest != 0; rest &= rest - 1)
        visit(64 * word + static_cast<std::size_t>(std::countr_zero(rest)));
  }

  const RayScene& rays_;
  float lift_m_;
  std::vector<glm::vec3> directions_, irradiances_over_pi_;
};

}  // namespace

glm::vec2 PlaneLights::texel_at(const glm::vec2& place_m) const {
  return (place_m - texels.rect.min_m) / (texels.rect.max_m - texels.rect.min_m) * glm::vec2(texels.size);
}

glm::vec3 PlaneLights::at(const glm::vec2& texel) const {
  const glm::vec2 place = glm::clamp(texel - 0.5f, glm::vec2(0), glm::vec2(texels.size - 1));
  const glm::ivec2 first(place), next = glm::min(first + 1, texels.size - 1);
  const glm::vec2 f = place - glm::vec2(first);
  const auto value = [&](int x, int y) { return irradiance_over_pi[static_cast<std::size_t>(y) * texels.size.x + x]; };
  return glm::mix(glm::mix(value(first.x, first.y), value(next.x, first.y), f.x),
                  glm::mix(value(first.x, next.y), value(next.x, next.y), f.x), f.y);
}

PlaneLights plane_lights(std::span<const LightSample> samples_tag, const RayScene& rays, const ReceiverTexels& texels,
                         const Bounds& object) {
  const Plane plane(samples_tag, rays, object);
  PlaneLights result{texels, std::vector<glm::vec3>(static_cast<std::size_t>(texels.size.x) * texels.size.y)};
  const glm::vec2 texel_m = (texels.rect.max_m - texels.rect.min_m) / glm::vec2(texels.size);
  const auto place = [&](int x, int y) { return texels.rect.min_m + (glm::vec2(x, y) + 0.5f) * texel_m; };
  const glm::ivec2 cells = (texels.size + kCell - 1) / kCell, nodes = cells + 1;
  std::vector<Bits> at_nodes(static_cast<std::size_t>(nodes.x) * nodes.y);
  parallel_for(static_cast<std::size_t>(nodes.y), 0, [&](std::size_t row) {
    std::vector<glm::vec2> places;
    places.reserve(static_cast<std::size_t>(nodes.x));
    for (int x = 0; x < nodes.x; ++x) places.push_back(place(kCell * x, kCell * static_cast<int>(row)));
    plane.find_seen(places, plane.all(), std::span(at_nodes).subspan(row * nodes.x, nodes.x));
  });
  parallel_for(static_cast<std::size_t>(cells.y), 0, [&](std::size_t row) {
    std::array<glm::vec2, kCell * kCell> places;
    std::array<Bits, kCell * kCell> seen;
    for (int column = 0; column < cells.x; ++column) {
      const Bits* first = &at_nodes[row * nodes.x + column];
      Bits agreed, asked;
      for (std::size_t word = 0; word < 2; ++word) {
        const std::uint64_t a = first[0][word], b = first[1][word], c = first[nodes.x][word], d = first[nodes.x + 1][word];
        agreed[word] = a & b & c & d;
        asked[word] = (a | b | c | d) & ~agreed[word];
      }
      for (int i = 0; i < kCell * kCell; ++i)
        places[i] = place(kCell * column + i % kCell, kCell * static_cast<int>(row) + i / kCell);
      plane.find_seen(places, asked, seen);
      const glm::vec3 common = plane.light_of(agreed);
      for (int i = 0; i < kCell * kCell; ++i) {
        const int x = kCell * column + i % kCell, y = kCell * static_cast<int>(row) + i / kCell;
        if (x < texels.size.x && y < texels.size.y)
          result.irradiance_over_pi[static_cast<std::size_t>(y) * texels.size.x + x] = common + plane.light_of(seen[i]);
      }
    }
  });
  return result;
}

}  // namespace catchlight::render
