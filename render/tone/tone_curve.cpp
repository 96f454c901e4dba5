#include "render/tone/tone_curve.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "catchlight/color.hpp"

namespace catchlight::render {
namespace {

/// The least luminance that counts: half the light of sRGB's first code of 8 bits. Darker than this, footage tells nothing.
constexpr double kDarkest = 0.5 / 255 / 12.92;
constexpr double kDeltaShare = 1e-3;
constexpr double kLowShare = 0.01, kHighShare = 0.99;
constexpr double kMaxGain = 64;

double percentile(const LuminanceHistogram& histogram, double pixels, double share) {
  double passed = 0;
  for (int bin = 0; bin < LuminanceHistogram::kBins; ++bin) {
    passed += histogram.bins[static_cast<std::size_t>(bin)].count;
    if (passed > 0 && passed >= share * pixels) return histogram.mean(bin);
  }
  return 0;
}

}  // namespace

void LuminanceHistogram::add(float luminance) {
  constexpr std::uint32_t kRestBits = 17, kFirst = ((127u - 32u) << (23 - kRestBits)) - 1;
  if (std::isnan(luminance)) return;
  if (luminance < 0x1p-32f) {
    ++bins[0].count;
    return;
  }
  const auto bits = std::bit_cast<std::uint32_t>(std::min(luminance, 4294967040.0f));
  Bin& bin = bins[(bits >> kRestBits) - kFirst];
  const std::uint32_t rest = bits & ((1u << kRestBits) - 1);
  ++bin.count;
  bin.rest_low += rest;
  bin.rest_high += bin.rest_low < rest ? 1 : 0;
}

void LuminanceHistogram::add(const LuminanceHistogram& other) {
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const Bin& from = other.bins[i];
    bins[i].count += from.count;
    bins[i].rest_low += from.rest_low;
    bins[i].rest_high += from.rest_high + (bins[i].rest_low < from.rest_low ? 1 : 0);
  }
}

double LuminanceHistogram::mean(int bin) const {
  if (bin == 0) return 0;
  const Bin& counted = bins[static_cast<std::size_t>(bin)];
  const double rest = (counted.rest_high * 0x1p32 + counted.rest_low) / counted.count;
  const int octave = (bin - 1) / 64 - 32;
  return std::ldexp(1 + ((bin - 1) % 64 + rest * 0x1p-17) / 64, octave);
}

SceneLuminance scene_luminance(const LuminanceHistogram& histogram) {
  double pixels = 0;
  for (const LuminanceHistogram::Bin& bin : histogram.bins) pixels += bin.count;
  if (pixels == 0) return {};
  SceneLuminance result;
  result.low = percentile(histogram, pixels, kLowShare);
  result.high = percentile(histogram, pixels, kHighShare);
  const double delta = kDeltaShare * std::max(result.high, kDarkest);
  double log_sum = 0;
  for (int bin = 0; bin < LuminanceHistogram::kBins; ++bin)
    if (const double count = histogram.bins[static_cast<std::size_t>(bin)].count; count > 0)
      log_sum += count * std::log(delta + histogram.mean(bin));
  result.average = std::max(std::exp(log_sum / pixels) - delta, 0.0);
  return result;
}

ToneCurve tone_curve(const SceneLuminance& luminance, const ToneSettings& settings) {
  ToneCurve curve;
  curve.gain = std::min(settings.key / luminance.average, kMaxGain);
  if (!settings.has_white_point) {
    curve.white = std::numeric_limits<double>::infinity();
    return curve;
  }
  const double stops = std::log2(std::max(luminance.high, kDarkest) / std::max(luminance.low, kDarkest));
  const double estimate = 1.5 * std::exp2(stops - 5);
  curve.white = std::max(std::min(estimate, curve.gain * luminance.high), 1.0);
  return curve;
}

glm::dvec3 luminance_weights(const glm::mat3& plate_from_rec709) {
  return kLuminanceWeights * glm::inverse(glm::dmat3(plate_from_rec709));
}

}  // namespace catchlight::render
