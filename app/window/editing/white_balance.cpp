#include "app/window/editing/white_balance.hpp"

#include <algorithm>
#include <cmath>

#include "app/settings/parameters.hpp"
#include "catchlight/color.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {

glm::dvec3 mean_light(const Plate& plate, const PlateColor& color) {
  const auto is_clipped = [](unsigned char code) { return code >= kClippingCode * 255; };
  if (plate.format != Plate::Format::rgb_f32 && std::ranges::any_of(codes_8_bit(plate), is_clipped))
    throw Error("clipped: choose something white or grey that is darker");
  const RawVector<float> light = linear_rgb(plate, color);
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i + 2 < light.size(); i += 3) sum += glm::dvec3(light[i], light[i + 1], light[i + 2]);
  return sum / (static_cast<double>(light.size()) / 3);
}

glm::dvec3 white_balance_for(const glm::dvec3& grey, const glm::dvec3& paper, const glm::dvec3& black) {
  constexpr double kMinLight = 0.003;  // about ten codes of sRGB: below, rounding and noise make the colour
  const glm::dvec3 light = grey - black;
  if (std::min({light.r, light.g, light.b}) < kMinLight) throw Error("too dark to tell its colour: choose something brighter");
  if (std::min({paper.r, paper.g, paper.b}) <= 0)
    throw Error("the probe is black in a channel: no balance makes its light white");
  const glm::dvec3 gains = light / glm::dot(kLuminanceWeights, light) / (paper / glm::dot(kLuminanceWeights, paper));
  const auto& allowed = std::get<VectorKind>(find_parameter("exposure.white_balance")->kind);
  if (glm::any(glm::lessThan(gains, glm::dvec3(allowed.min))) || glm::any(glm::greaterThan(gains, glm::dvec3(allowed.max))))
    throw Error("too strongly coloured to be white or grey");
  return glm::round(1000.0 * gains) / 1000.0;
}

}  // namespace catchlight::app
