#include "render/mesh/texture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "catchlight/color.hpp"

namespace catchlight::render {
namespace {

/// Beyond a million repeats a float has no fraction left: the place within the texture is then arbitrary, but must stay an int.
constexpr float kMaxRepeats = 1e6f;

const std::array<float, 256>& light_of_code() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light{};
    for (std::size_t code = 0; code < light.size(); ++code)
      light[code] = static_cast<float>(linear_from_srgb(static_cast<double>(code) / 255));
    return light;
  }();
  return table;
}

std::uint8_t code_of(float linear, bool is_srgb) {
  const double value = is_srgb ? srgb_from_linear(static_cast<double>(linear)) : static_cast<double>(linear);
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

glm::vec4 texel(const TextureLevel& level, bool is_srgb, int x, int y) {
  const std::uint8_t* code = &level.rgba[4 * (static_cast<std::size_t>(y) * level.width + x)];
  const auto linear = [&](int c) { return is_srgb ? light_of_code()[code[c]] : static_cast<float>(code[c]) / 255; };
  return {linear(0), linear(1), linear(2), static_cast<float>(code[3]) / 255};
}

TextureLevel halved(const TextureLevel& from, bool is_srgb) {
  TextureLevel to{std::max(from.width / 2, 1), std::max(from.height / 2, 1), {}};
  to.rgba.reserve(4 * static_cast<std::size_t>(to.width) * to.height);
  // An odd row or column more is shared out among the last.
  const auto span = [](int i, int size, int half) { return std::pair(i * size / half, (i + 1) * size / half); };
  for (int y = 0; y < to.height; ++y) {
    const std::pair<int, int> rows = span(y, from.height, to.height);
    for (int x = 0; x < to.width; ++x) {
      const std::pair<int, int> columns = span(x, from.width, to.width);
      glm::vec4 sum(0);
      for (int sy = rows.first; sy < rows.second; ++sy)
        for (int sx = columns.first; sx < columns.second; ++sx) sum += texel(from, is_srgb, sx, sy);
      sum /= static_cast<float>((rows.second - rows.first) * (columns.second - columns.first));
      for (int c = 0; c < 4; ++c) to.rgba.push_back(code_of(sum[c], is_srgb && c < 3));
    }
  }
  return to;
}

int wrapped(int i, int size, TextureWrap wrap) {
  if (wrap == TextureWrap::clamp) return std::clamp(i, 0, size - 1);
  const int period = wrap == TextureWrap::mirror ? 2 * size : size;
  const int inside = ((i % period) + period) % period;
  return inside < size ? inside : 2 * size - 1 - inside;
}

glm::vec4 between_texels(const Texture& texture, int level_index, const glm::vec2& uv) {
  const TextureLevel& level = texture.levels[static_cast<std::size_t>(level_index)];
  const glm::vec2 at = glm::clamp(uv, -kMaxRepeats, kMaxRepeats) * glm::vec2(level.width, level.height) - 0.5f;
  const glm::vec2 corner = glm::floor(at), share = at - corner;
  const auto value = [&](int dx, int dy) {
    return texel(level, texture.is_srgb, wrapped(static_cast<int>(corner.x) + dx, level.width, texture.wrap[0]),
                 wrapped(static_cast<int>(corner.y) + dy, level.height, texture.wrap[1]));
  };
  return glm::mix(glm::mix(value(0, 0), value(1, 0), share.x), glm::mix(value(0, 1), value(1, 1), share.x), share.y);
}

glm::vec4 between_levels(const Texture& texture, float level, const glm::vec2& uv) {
  const int last = static_cast<int>(texture.levels.size()) - 1, fine = std::clamp(static_cast<int>(level), 0, last);
  const float share = std::clamp(level - static_cast<float>(fine), 0.0f, 1.0f);
  const glm::vec4 value = between_texels(texture, fine, uv);
  return share > 0 && fine < last ? glm::mix(value, between_texels(texture, fine + 1, uv), share) : value;
}

}  // namespace

Texture make_texture(std::string name, TextureLevel picture, bool is_srgb, std::array<TextureWrap, 2> wrap) {
  Texture texture{std::move(name), is_srgb, wrap, {}};
  texture.levels.push_back(std::move(picture));
  while (texture.levels.back().width > 1 || texture.levels.back().height > 1)
    texture.levels.push_back(halved(texture.levels.back(), is_srgb));
  return texture;
}

glm::vec4 look_up(const Texture& texture, const glm::vec2& uv, const TextureFootprint& footprint) {
  const TextureLevel& whole = texture.levels.front();
  const glm::vec2 size(whole.width, whole.height);
  glm::vec2 longer = footprint.along_x, shorter = footprint.along_y;
  if (glm::length(longer * size) < glm::length(shorter * size)) std::swap(longer, shorter);
  const float length = glm::length(longer * size), width = std::max(glm::length(shorter * size), length / kMaxAnisotropy);
  if (!std::isfinite(uv.x + uv.y + length)) return texel(texture.levels.back(), texture.is_srgb, 0, 0);
  const int places = std::clamp(static_cast<int>(std::ceil(length / std::max(width, 1.0f))), 1, kMaxAnisotropy);
  const float level = std::log2(std::max(std::max(width, length / static_cast<float>(places)), 1.0f));
  glm::vec4 sum(0);
  for (int i = 0; i < places; ++i)
    sum += between_levels(texture, level, uv + ((static_cast<float>(i) + 0.5f) / static_cast<float>(places) - 0.5f) * longer);
  return sum / static_cast<float>(places);
}

}  // namespace catchlight::render
