// The photographic operator, extended, with its exposure and white point found from the picture: Reinhard, Stark, Shirley and
// Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002; Reinhard, "Parameter Estimation for Photographic
// Tone Reproduction", Journal of Graphics Tools 7(1), 2002. No GL: shaders/tone.frag draws the same.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "catchlight/tone_curve.hpp"

namespace catchlight::render {

/// Luminances of a frame, binned by the bits of the float: 64 bins an octave from 2^-32 to 2^32, so that no logarithm of the
/// GPU's is needed and the counts do not depend on the order of pixels.
struct LuminanceHistogram {
  static constexpr int kBins = 1 + 64 * 64;  ///< bin 0: black, whatever is darker than 2^-32, negative too

  struct Bin {
    std::uint32_t count, rest_low, rest_high;  ///< rest: sum of the 17 mantissa bits below the bin's, 64 bits in two words
  };
  std::array<Bin, kBins> bins{};

  /// Counts a pixel, as shaders/tone_meter.frag does: one with a NaN for nothing, an infinite one as 2^32.
  void add(float luminance);
  void add(const LuminanceHistogram& other);

  /// Mean luminance of the bin's pixels, which must be some.
  double mean(int bin) const;
};

/// A frame's luminances in linear light, 1 = sensor white.
struct SceneLuminance {
  double average = 0;        ///< exp(mean(log(delta + L))) - delta: a constant frame's is itself, a black frame's is 0
  double low = 0, high = 0;  ///< 1 % and 99 % percentiles: one sun pixel is neither
};

/// delta is a thousandth of `high`: the answer scales with the light.
SceneLuminance scene_luminance(const LuminanceHistogram& histogram);

struct ToneSettings {
  bool enabled = false;
  double key = 0.18;            ///< what the log-average becomes
  bool has_white_point = true;  ///< false: nothing burns out, L / (1 + L)

  bool operator==(const ToneSettings&) const = default;
};

/// The curve that a frame calls for. gain = key / average, at most 2^6: what is darker is noise. White is the 2002 estimate
/// 1.5 * 2^(log2 high - log2 low - 5), but not above the frame's own highlights, as whites would go grey, and not below 1, where
/// the curve is a straight line, as a flat frame would burn out.
ToneCurve tone_curve(const SceneLuminance& luminance, const ToneSettings& settings);

/// Luminance weights of linear RGB in the primaries reached by `plate_from_rec709`.
glm::dvec3 luminance_weights(const glm::mat3& plate_from_rec709);

}  // namespace catchlight::render
