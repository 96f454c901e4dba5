#include "render/cpu/receiver/receiver_shadow.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "catchlight/util/parallel.hpp"
#include "render/cpu/receiver/plane_lights.hpp"
#include "render/cpu/surface/transferred_light.hpp"

namespace catchlight::render {
namespace {

// Raise when the texture or its members change: older files then no longer match.
constexpr std::uint32_t kVersion = 1;

/// The outermost points fade to 1: the end of the grid must not be seen.
constexpr float kFadePoints = 3;
constexpr int kMaxTexels = 2048;
constexpr float kTexelsPerGridCell = 4;

/// The code of a ratio of 1; kMaxShadowRatio has the last code.
constexpr float kOne = 16384;

using Texel = std::uint16_t __attribute__((vector_size(8)));

Texel coded(const glm::vec3& ratio) {
  const glm::vec3 code = glm::min(kOne * ratio + 0.5f, 65535.0f);
  return Texel{static_cast<std::uint16_t>(code.x), static_cast<std::uint16_t>(code.y), static_cast<std::uint16_t>(code.z),
               static_cast<std::uint16_t>(kOne)};
}

bool is_one(Texel texel) {
  static constexpr auto kCode = static_cast<std::uint16_t>(kOne);
  return std::bit_cast<std::uint64_t>(texel) == std::bit_cast<std::uint64_t>(Texel{kCode, kCode, kCode, kCode});
}

/// Faint shadows go over to none, so that where they end is not seen.
glm::vec3 faded(const glm::vec3& ratio) {
  const glm::vec3 change = glm::abs(ratio - 1.0f);
  const float most = std::max({change.x, change.y, change.z});
  return 1.0f + glm::smoothstep(kInvisibleShadow, 3 * kInvisibleShadow, most) * (ratio - 1.0f);
}

/// 1 well within a rectangle of `size` texels, 0 at its rim.
float rim_fade(const glm::vec2& texel, const glm::vec2& size) {
  const glm::vec2 to_rim = glm::min(texel, size - texel);
  return glm::smoothstep(0.0f, kFadePoints, std::min(to_rim.x, to_rim.y));
}

glm::vec4 bspline_weights(float f) {
  const float g = 1 - f, w0 = g * g * g / 6, w3 = f * f * f / 6, w1 = 2.0f / 3 - 0.5f * f * f * (2 - f);
  return {w0, w1, 1 - w0 - w1 - w3, w3};
}

/// The grid's values as the coefficients of a cubic B-spline, at `cells` from its first point.
glm::vec3 smooth(std::span<const glm::vec3> values, const glm::ivec2& points, const glm::vec2& cells) {
  const glm::ivec2 base(glm::floor(cells));
  const glm::vec2 f = cells - glm::floor(cells);
  const glm::vec4 across = bspline_weights(f.x), down = bspline_weights(f.y);
  glm::vec3 sum(0);
  for (int j = 0; j < 4; ++j) {
    const int row = std::clamp(base.y + j - 1, 0, points.y - 1) * points.x;
    glm::vec3 line(0);
    for (int i = 0; i < 4; ++i)
      line += across[i] * values[static_cast<std::size_t>(row + std::clamp(base.x + i - 1, 0, points.x - 1))];
    sum += down[j] * line;
  }
  return sum;
}

}  // namespace

ReceiverShadow::ReceiverShadow(const Transfer& transfer, const RayScene& rays, const Bounds& object)
    : transfer_(transfer), rays_(rays), object_(object) {}

void ReceiverShadow::update(const SplitLight& light_tag, bool stands_still, const KeyedCache& kept) {
  static constexpr auto kKind = "receiver";
  const auto pass = [this](CacheStream& file) { archive(file); };
  if (kept.read(kKind, kVersion, pass)) return;
  const std::vector<glm::vec3> grid_light = transferred_light(transfer_.receiver, transfer_.receiver_direct, light_tag);
  const OpenPlaneLight open = open_plane_light(transfer_.receiver_unshadowed, light_tag);
  const PlaneRect of_lights = shadow_reach(light_tag.samples, open, object_);
  PlaneLights lights;
  if (!of_lights.empty())
    lights = plane_lights(light_tag.samples, rays_, receiver_texels(of_lights, object_, stands_still ? 1 : 2), object_);
  draw_ratio(open, grid_light, lights);
  crop();
  kept.keep(kKind, kVersion, pass);
}

void ReceiverShadow::archive(CacheStream& file) {
  file(reach_);
  file(size_);
  file(texels_per_m_);
  file(ratio_);
}

void ReceiverShadow::draw_ratio(const OpenPlaneLight& open, std::span<const glm::vec3> grid_light, const PlaneLights& lights) {
  const ReceiverGrid& grid = transfer_.grid;
  const glm::vec3 open_rest(open.rest), open_lights(open.lights), open_all(open.rest + open.lights);
  const glm::ivec2 points(grid.columns, grid.rows);
  const glm::vec2 cell_m = (grid.max_m - grid.min_m) / glm::vec2(points - 1);
  glm::vec2 texel_m = cell_m / kTexelsPerGridCell;
  reach_ = {grid.min_m, grid.max_m};
  if (!lights.empty()) {
    reach_ = unite(reach_, lights.texels.rect);
    texel_m = glm::min(texel_m, (lights.texels.rect.max_m - lights.texels.rect.min_m) / glm::vec2(lights.texels.size));
  }
  size_ = glm::clamp(glm::ivec2(glm::ceil((reach_.max_m - reach_.min_m) / texel_m)), 2, kMaxTexels);
  texels_per_m_ = glm::vec2(size_) / (reach_.max_m - reach_.min_m);
  ratio_.resize(static_cast<std::size_t>(size_.x) * size_.y);
  parallel_for(static_cast<std::size_t>(size_.y), 0, [&](std::size_t row) {
    for (int x = 0; x < size_.x; ++x) {
      const glm::vec2 place = reach_.min_m + (glm::vec2(x, row) + 0.5f) / texels_per_m_;
      const glm::vec2 cells = (place - grid.min_m) / cell_m;
      const float fade = rim_fade(cells, glm::vec2(points - 1));
      glm::vec3 sum = open_rest + open_lights;
      if (fade > 0) sum += fade * (smooth(grid_light, points, cells) - open_rest);
      if (!lights.empty()) {
        const glm::vec2 texel = lights.texel_at(place);
        const float light_fade = rim_fade(texel, glm::vec2(lights.texels.size));
        if (light_fade > 0) sum += light_fade * (lights.at(texel) - open_lights);
      }
      glm::vec3 ratio(1);
      // A plane that gets no light of a colour has no shadow in it.
      for (int c = 0; c < 3; ++c)
        if (open_all[c] > 1e-9f && sum[c] >= 0) ratio[c] = std::min(sum[c] / open_all[c], kMaxShadowRatio);
      ratio = faded(ratio);
      ratio_[row * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x)] = coded(ratio);
    }
  });
}

/// Cuts off what nobody sees, but for a texel around.
void ReceiverShadow::crop() {
  glm::ivec2 low = size_, high(-1);
  for (int y = 0; y < size_.y; ++y) {
    for (int x = 0; x < size_.x; ++x) {
      if (is_one(ratio_[static_cast<std::size_t>(y) * size_.x + x])) continue;
      low = glm::min(low, {x, y}), high = glm::max(high, {x, y});
    }
  }
  if (high.x < 0) low = high = glm::ivec2(0);
  low = glm::max(low - 1, 0), high = glm::min(high + 1, size_ - 1);
  const glm::ivec2 size = high - low + 1;
  std::vector<Texel> kept(static_cast<std::size_t>(size.x) * size.y);
  for (int y = 0; y < size.y; ++y)
    std::copy_n(&ratio_[static_cast<std::size_t>(low.y + y) * size_.x + low.x], size.x,
                &kept[static_cast<std::size_t>(y) * size.x]);
  reach_ = {reach_.min_m + glm::vec2(low) / texels_per_m_, reach_.min_m + glm::vec2(high + 1) / texels_per_m_};
  size_ = size;
  ratio_ = std::move(kept);
}

void ReceiverShadow::prefetch(const glm::vec2& place_m) const {
  const glm::vec2 texel = (place_m - reach_.min_m) * texels_per_m_ - 0.5f;
  if (!(texel.x > 0 && texel.y > 0 && texel.x < static_cast<float>(size_.x - 1) && texel.y < static_cast<float>(size_.y - 1)))
    return;
  const Texel* first = &ratio_[static_cast<std::size_t>(texel.y) * size_.x + static_cast<std::size_t>(texel.x)];
  __builtin_prefetch(first);
  __builtin_prefetch(first + size_.x);
}

glm::vec3 ReceiverShadow::ratio(const glm::vec2& place_m) const {
  const glm::vec2 texel = (place_m - reach_.min_m) * texels_per_m_;
  if (!(texel.x > 0 && texel.y > 0 && texel.x < static_cast<float>(size_.x) && texel.y < static_cast<float>(size_.y)))
    return glm::vec3(1);
  const glm::vec2 at = glm::clamp(texel - 0.5f, glm::vec2(0), glm::vec2(size_ - 1));
  const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
  const std::size_t right = x + 1 < size_.x ? 1 : 0, below = y + 1 < size_.y ? static_cast<std::size_t>(size_.x) : 0;
  const Texel* first = &ratio_[static_cast<std::size_t>(y) * size_.x + x];
  const Texel corners[4] = {first[0], first[right], first[below], first[below + right]};
  if (is_one(corners[0]) && is_one(corners[1]) && is_one(corners[2]) && is_one(corners[3])) return glm::vec3(1);
  const auto value = [&](int k) { return __builtin_convertvector(corners[k], Float4); };
  const float across = at.x - static_cast<float>(x);
  const Float4 upper = blend(value(0), value(1), across), lower = blend(value(2), value(3), across);
  return rgb(blend(upper, lower, at.y - static_cast<float>(y)) * splat(1 / kOne));
}

}  // namespace catchlight::render
