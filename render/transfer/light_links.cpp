#include "render/transfer/light_links.hpp"

namespace catchlight::render {
namespace {

const float* floats(std::span<const glm::vec3> values) {
  return reinterpret_cast<const float*>(values.data());  // an empty span may have no address to take a member of
}

/// How many links ahead memory is asked for what they need: it lies all over, and would have to be waited for.
constexpr std::size_t kAhead = 2;

[[gnu::always_inline]] inline void fetch(const float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; i += 16) __builtin_prefetch(values + i);
}

[[gnu::target_clones("avx2", "default")]] void sum_surfaces(std::span<const LightLinks::Surface> links,
                                                            const std::uint32_t* corners, const float* sent, float factor,
                                                            std::size_t count, float* __restrict sum) {
  const auto corner = [&](std::size_t k, std::size_t c) { return sent + corners[3 * links[k].triangle + c] * count; };
  for (std::size_t k = 0; k < links.size(); ++k) {
    for (std::size_t c = 0; c < 3 && k + kAhead < links.size(); ++c) fetch(corner(k + kAhead, c), count);
    const float *a = corner(k, 0), *b = corner(k, 1), *c = corner(k, 2);
    const float share_a = factor * links[k].share[0], share_b = factor * links[k].share[1], share_c = factor * links[k].share[2];
    for (std::size_t i = 0; i < count; ++i) sum[i] += share_a * a[i] + share_b * b[i] + share_c * c[i];
  }
}

[[gnu::target_clones("avx2", "default")]] void sum_receiver(std::span<const LightLinks::Receiver> links, const float* sent,
                                                            float factor, std::size_t count, float* __restrict sum) {
  for (std::size_t k = 0; k < links.size(); ++k) {
    if (k + kAhead < links.size()) fetch(sent + links[k + kAhead].grid_point * count, count);
    const float* from = sent + links[k].grid_point * count;
    const float share = factor * links[k].share;
    for (std::size_t i = 0; i < count; ++i) sum[i] += share * from[i];
  }
}

}  // namespace

/// Neighbouring rays often end at one point.
void LightLinks::add_receiver(std::size_t grid_point, float share) {
  const std::size_t begin = ends_.empty() ? 0 : ends_.back().receiver;
  if (receiver_.size() > begin && receiver_.back().grid_point == grid_point)
    receiver_.back().share += share;
  else
    receiver_.push_back({static_cast<std::uint32_t>(grid_point), share});
}

void LightLinks::gather(std::size_t point, std::size_t parts, float factor, std::span<const std::uint32_t> corners,
                        std::span<const glm::vec3> from_object, std::span<const glm::vec3> from_receiver,
                        std::span<glm::vec3> arriving) const {
  const End begin = point == 0 ? End{} : ends_[2 * point - 1], end = ends_[2 * point + parts - 1];
  const std::size_t count = 3 * arriving.size();
  float* sum = reinterpret_cast<float*>(arriving.data());
  sum_surfaces(std::span(surface_).subspan(begin.surface, end.surface - begin.surface), corners.data(), floats(from_object),
               factor, count, sum);
  sum_receiver(std::span(receiver_).subspan(begin.receiver, end.receiver - begin.receiver), floats(from_receiver), factor, count,
               sum);
}

}  // namespace catchlight::render
