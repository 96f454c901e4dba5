// How a camera's codes stand for light: by formula, or by a table where no formula has it. The one place where codes become light
// and light codes; shaders/color.glsl says the same to the graphics card, and a test holds the two together.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace catchlight {

/// How the footage's codes (0..1) relate to scene-linear light (1 = sensor white). Video tagged BT.709 is read as sRGB:
/// cameras' BT.709 pictures are graded for, and converted from, the sRGB curve far more often than the bare BT.709 one.
enum class TransferFunction { srgb, linear, gamma22, gamma28, pq, hlg };

/// Light of a code. PQ (SMPTE ST 2084) and HLG (ARIB STD-B67, scene-referred) are scaled so that 203 cd/m2, reference white, is 1
/// (ITU-R BT.2408).
double linear_from_code(TransferFunction transfer, double code);

/// The inverse; light below 0 that has no code there (all but sRGB and linear) gets black's.
double code_from_linear(TransferFunction transfer, double linear);

/// The clipping level: a pixel whose integer code is this or more may have been brighter than it shows. Compression and noise
/// leave a clipped surface a little below the last code; of 8 bits, the codes from 252 on count. It is a code and no light: what
/// light the last codes mean is the response's business. Float codes do not end at 1, and are never clipped.
inline constexpr double kClippingCode = 0.985;

/// Light of evenly spaced codes from 0 to 1, a table a channel, red first. Straight lines between; beyond the ends the first and
/// the last line go on, so that codes outside limited range, and light beyond white, have their places.
class ResponseCurve {
 public:
  using Tables = std::array<std::vector<float>, 3>;

  /// `light`: at least two values a channel, equally many, finite, each above the one before.
  explicit ResponseCurve(Tables light) : light_(std::move(light)) {}

  const Tables& light() const { return light_; }
  std::size_t size() const { return light_[0].size(); }

  double linear_from_code(double code, int channel) const {
    const std::vector<float>& light = light_[static_cast<std::size_t>(channel)];
    const double place = code * static_cast<double>(size() - 1);
    const double step = std::clamp(std::floor(place), 0.0, static_cast<double>(size() - 2));
    const double from = light[static_cast<std::size_t>(step)], to = light[static_cast<std::size_t>(step) + 1];
    return from + (place - step) * (to - from);
  }

  double code_from_linear(double linear, int channel) const {
    const std::vector<float>& light = light_[static_cast<std::size_t>(channel)];
    const auto above = std::upper_bound(light.begin() + 1, light.end() - 1, linear);
    const double from = *(above - 1), to = *above;
    return (static_cast<double>(above - 1 - light.begin()) + (linear - from) / (to - from)) / static_cast<double>(size() - 1);
  }

 private:
  Tables light_;
};

/// The whole of a camera's response: a curve stands in for the formula.
struct CameraResponse {
  TransferFunction transfer = TransferFunction::srgb;
  std::shared_ptr<const ResponseCurve> curve = {};
};

inline double linear_from_code(const CameraResponse& response, double code, int channel) {
  return response.curve ? response.curve->linear_from_code(code, channel) : linear_from_code(response.transfer, code);
}

inline double code_from_linear(const CameraResponse& response, double linear, int channel) {
  return response.curve ? response.curve->code_from_linear(linear, channel) : code_from_linear(response.transfer, linear);
}

}  // namespace catchlight
