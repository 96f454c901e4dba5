#include "app/window/picture/false_colors.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/color.hpp"

namespace catchlight::app {
namespace {

constexpr int kMaxStop = 4;
constexpr int kCrushedCode = 1, kClippedCode = 254;

/// The zone of a pixel: 0 crushed, 1 to 9 the stops, 10 clipped.
std::size_t zone_of(const unsigned char* code) {
  static const std::array<double, 256> light_of_code = [] {
    std::array<double, 256> light{};
    for (std::size_t c = 0; c < 256; ++c) light[c] = linear_from_srgb(static_cast<double>(c) / 255);
    return light;
  }();
  const int brightest = std::max({code[0], code[1], code[2]});
  if (brightest >= kClippedCode) return 2 * kMaxStop + 2;
  if (brightest <= kCrushedCode) return 0;
  const double light =
      glm::dot(kLuminanceWeights, glm::dvec3(light_of_code[code[0]], light_of_code[code[1]], light_of_code[code[2]]));
  const auto stop = static_cast<int>(std::lround(std::log2(std::max(light, 1e-6) / 0.18)));
  return static_cast<std::size_t>(std::clamp(stop, -kMaxStop, kMaxStop) + kMaxStop + 1);
}

}  // namespace

RgbPicture difference(const RgbPicture& a, const RgbPicture& b, float gain) {
  RgbPicture result{a.width, a.height, std::vector<unsigned char>(a.rgb.size())};
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    result.rgb[i] = static_cast<unsigned char>(std::clamp(128 + gain * (float{1} * a.rgb[i] - b.rgb[i]), 0.0f, 255.0f));
  return result;
}

const std::vector<Zone>& exposure_zones() {
  static const std::vector<Zone> zones = {{{0, 0, 0}, "black"},   {{70, 0, 110}, "−4"},        {{50, 30, 170}, "−3"},
                                          {{30, 90, 200}, "−2"},  {{30, 150, 140}, "−1"},      {{120, 120, 120}, "mid grey"},
                                          {{110, 170, 60}, "+1"}, {{220, 210, 50}, "+2"},      {{240, 140, 30}, "+3"},
                                          {{230, 50, 40}, "+4"},  {{255, 255, 255}, "clipped"}};
  return zones;
}

RgbPicture zones(const RgbPicture& picture) {
  RgbPicture result{picture.width, picture.height, std::vector<unsigned char>(picture.rgb.size())};
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3)
    std::ranges::copy(exposure_zones()[zone_of(&picture.rgb[i])].rgb, result.rgb.begin() + static_cast<std::ptrdiff_t>(i));
  return result;
}

}  // namespace catchlight::app
