#include "render/cpu/mirror/cube_texture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/probe/cube_map.hpp"
#include "render/scene_check.hpp"

namespace catchlight::render {
namespace {

constexpr int kFaces = 6;

/// Bits of a float's fraction that a texel has no room for, and how far the exponents lie apart.
constexpr int kLessFraction = 13, kLessExponent = 95;

}  // namespace

/// A place on a face, from -1 to 1, right and down.
struct CubeTexture::Place {
  int face;
  float s, t;

  explicit Place(const glm::vec3& d) {
    const glm::vec3 a = glm::abs(d);
    if (a.x >= a.y && a.x >= a.z) {
      const float scale = 1 / a.x;
      face = d.x > 0 ? 0 : 1, s = (d.x > 0 ? -d.z : d.z) * scale, t = -d.y * scale;
    } else if (a.y >= a.z) {
      const float scale = 1 / a.y;
      face = d.y > 0 ? 2 : 3, s = d.x * scale, t = (d.y > 0 ? d.z : -d.z) * scale;
    } else {
      const float scale = 1 / a.z;
      face = d.z > 0 ? 4 : 5, s = (d.z > 0 ? d.x : -d.x) * scale, t = -d.y * scale;
    }
  }
};

CubeTexture::Texel CubeTexture::coded(const float* rgb) {
  constexpr std::uint32_t kOffset = kLessExponent << 23, kHalf = 1u << (kLessFraction - 1);
  constexpr auto kMin = std::bit_cast<float>(kOffset + (1u << 23)), kMax = std::bit_cast<float>(kOffset + (0xffffu << 13));
  Texel texel{};
  for (int c = 0; c < 3; ++c)
    if (std::isfinite(rgb[c]) && rgb[c] >= kMin)
      texel[c] =
          static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(std::min(rgb[c], kMax)) - kOffset + kHalf) >> kLessFraction);
  return texel;
}

CubeTexture::Level CubeTexture::make_level(const Image& faces) {
  const int size = faces.width, stride = size + 2;
  Level level{size, std::vector<Texel>(static_cast<std::size_t>(kFaces) * stride * stride)};
  for (int face = 0; face < kFaces; ++face) {
    for (int y = -1; y <= size; ++y) {
      for (int x = -1; x <= size; ++x) {
        int from_face = face, from_x = x, from_y = y;
        if (x < 0 || y < 0 || x >= size || y >= size) {
          const Place beyond(glm::vec3(cube_texel_direction(face, size, x, y)));
          const auto texel = [&](float s) { return std::clamp(static_cast<int>((0.5f * s + 0.5f) * size), 0, size - 1); };
          from_face = beyond.face, from_x = texel(beyond.s), from_y = texel(beyond.t);
        }
        const std::size_t at = (static_cast<std::size_t>(face) * stride + y + 1) * stride + x + 1;
        level.texels[at] = coded(faces.pixel(from_x, from_face * size + from_y));
      }
    }
  }
  return level;
}

CubeTexture::CubeTexture(const ReflectionMap& map) {
  check_cubes(map);
  for (const Image& level : map.levels) levels_.push_back(make_level(level));
  if (levels_.empty()) levels_.push_back(make_level(Image(1, kFaces)));
}

CubeTexture::Cell CubeTexture::cell_at(const Level& level, const Place& place) {
  const float x = (0.5f * place.s + 0.5f) * static_cast<float>(level.size) + 0.5f;
  const float y = (0.5f * place.t + 0.5f) * static_cast<float>(level.size) + 0.5f;
  const int left = static_cast<int>(x), top = static_cast<int>(y), stride = level.size + 2;
  return {&level.texels[(static_cast<std::size_t>(place.face) * stride + top) * stride + left], x - static_cast<float>(left),
          y - static_cast<float>(top)};
}

glm::vec3 CubeTexture::sample(const glm::vec3& direction, float level) const {
  const Place place(direction);
  return rgb(between_levels(level, levels_.size(), [&](std::size_t number) {
    const Cell cell = cell_at(levels_[number], place);
    const int stride = levels_[number].size + 2;
    const auto light = [&](int at) {
      using Bits = std::uint32_t __attribute__((vector_size(16)));
      constexpr auto kScale = std::bit_cast<float>((127u + kLessExponent) << 23);
      return std::bit_cast<Float4>(__builtin_convertvector(cell.first[at], Bits) << kLessFraction) * splat(kScale);
    };
    return blend(blend(light(0), light(1), cell.across), blend(light(stride), light(stride + 1), cell.across), cell.down);
  }));
}

void CubeTexture::prefetch(const glm::vec3& direction, float level) const {
  const Place place(direction);
  between_levels(level, levels_.size(), [&](std::size_t number) {
    const Texel* texel = cell_at(levels_[number], place).first;
    const int stride = levels_[number].size + 2;
    for (const Texel* corner : {texel, texel + 1, texel + stride, texel + stride + 1}) __builtin_prefetch(corner);
    return Float4{};
  });
}

}  // namespace catchlight::render
