// Makes codes of the composite's linear light: metering, tone curve, the footage's response, over the whole frame; as TonePass
// does on a card.
#pragma once

#include <optional>

#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/tone_curve.hpp"
#include "render/cpu/glare/classic_glare.hpp"
#include "render/settings.hpp"
#include "render/tone/tone_curve.hpp"

namespace catchlight::render {

/// Luminances of a frame (RGBA, linear), with ToneMeter's rules: a pixel with a NaN counts for nothing, an infinite one as 2^32.
LuminanceHistogram measure_luminances(const Image& light, const glm::dvec3& luminance_weights);

class CpuTone {
 public:
  explicit CpuTone(const CompositorSettings& settings);

  /// The curve that the composite (RGBA, linear light, the whole frame) calls for.
  ToneCurve meter(const Image& light, const PlateColor& color) const;

  /// Turns the composite into codes, with bloom and streaks of the classic look where it is chosen; alpha becomes 1.
  /// `codes_end_at_1`: as those of integers do.
  void apply(Image& light, const PlateColor& color, const ToneCurve& curve, bool codes_end_at_1);

 private:
  ToneSettings settings_;
  std::optional<ClassicGlare> classic_;  ///< none: another look, or no glare
};

}  // namespace catchlight::render
