#include "render/transfer/light_links.hpp"

namespace catchlight::render {
namespace {

const float* floats(std::span<const glm::vec3> values) {
  return &values.data()->x;
}

[[gnu::target_clones("avx2", "default")]] void add_surfaces(std::span<const LightLinks::Surface> links,
                                                            const std::uint32_t* corners, const float* sent, std::size_t count,
                                                            float* __restrict sum) {
  for (const LightLinks::Surface& link : links) {
    const std::uint32_t* corner = corners + std::size_t{3} * link.triangle;
    const float *a = sent + corner[0] * count, *b = sent + corner[1] * count, *c = sent + corner[2] * count;
    const float share_a = link.share[0], share_b = link.share[1], share_c = link.share[2];
    for (std::size_t i = 0; i < count; ++i) sum[i] += share_a * a[i] + share_b * b[i] + share_c * c[i];
  }
}

}  // namespace

void LightLinks::gather(std::size_t point, std::span<const std::uint32_t> corners, std::span<const glm::vec3> from_object,
                        std::span<const glm::vec3> from_receiver, std::span<glm::vec3> arriving) const {
  const End begin = point == 0 ? End{} : ends_[point - 1], end = ends_[point];
  const std::size_t count = 3 * arriving.size();
  float* sum = &arriving.data()->x;
  add_surfaces(std::span(surface_).subspan(begin.surface, end.surface - begin.surface), corners.data(), floats(from_object),
               count, sum);
  for (std::size_t k = begin.receiver; k < end.receiver; ++k) {
    const float* sent = floats(from_receiver) + receiver_[k].grid_point * count;
    for (std::size_t i = 0; i < count; ++i) sum[i] += receiver_[k].share * sent[i];
  }
}

}  // namespace catchlight::render
