// What glare looks like, and how passes on a grid get there; no GL needed. Lengths are in shares of the frame's height
// ("heights") or in texels of a grid of so many rows a height, so that look, brightness and cost do not depend on the frame's
// resolution.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

/// The grid that glare is computed on: square texels fixed to the frame, with a margin around it for what is on its way in or
/// out.
struct GlareGrid {
  double texel_px;    ///< at least 1: small frames have fewer rows
  int columns, rows;  ///< with the margins

  double rows_per_height(int frame_height) const { return frame_height / texel_px; }
  PixelRect all() const { return {0, 0, columns, rows}; }
  /// The grid of half of the resolution, so many times; its margins are as many texels.
  GlareGrid halved(int times) const;
  /// Texels that touch these pixels of the frame, grown by `more` texels.
  PixelRect texels(const PixelRect& pixels, int more) const;
  /// Pixels of the frame under these texels.
  PixelRect pixels(const PixelRect& texels) const;
};

GlareGrid make_glare_grid(int frame_width, int frame_height, int wanted_rows);

/// How many texels beyond a pixel the first filter carries its light, and beyond a texel the gate looks.
inline constexpr int kFilterReach = 2, kGateReach = 2;
/// Texels around a bright pixel that its gate can open for, and those that the gate looks at there.
inline constexpr int kExcessReach = kFilterReach + kGateReach, kLightReach = kExcessReach + kGateReach;

/// Texels of the grid halved `level` times that touch these of the grid, and as many around them as the way up reads, or else
/// `around`.
PixelRect texels_at(const PixelRect& texels, const GlareGrid& grid, int level, int around = 3);

/// Bloom is a sum of round Gaussians, each twice as wide as the one before: a narrow core with a long tail.
struct BloomGaussian {
  double weight;  ///< all weights together are 1
  double sigma_heights;
};
inline constexpr int kBloomGaussians = 6;
std::array<BloomGaussian, kBloomGaussians> bloom_gaussians();

/// One of these Gaussians as drawn: at level `level` of a pyramid whose levels halve the resolution, blurred there by
/// gaussian_taps().
struct BloomBlur {
  int level;
  double weight;
  std::vector<double> taps;  ///< a single one where going down and up the pyramid blurs enough
};
/// The Gaussians of the bloom, in the order of their levels. What going down and up the pyramid blurs is part of the stated
/// width.
std::vector<BloomBlur> plan_bloom(double rows_per_height);

/// Weights of a Gaussian that sum to 1 over both sides; at distance 0, 1, 2 ... One where there is nothing to blur.
std::vector<double> gaussian_taps(double variance);

/// What is left of a streak one height further on, per channel, as natural logarithm (negative).
glm::dvec3 streak_log_per_height(const GlareSettings& settings);

/// The directions in which a highlight's streaks leave it, unit vectors, y down.
std::vector<glm::dvec2> streak_directions(int count, double rotation_deg);

/// One pass: samples 0 ... count - 1 of the source at target - s * pace, weighted gain * falloff^s.
struct StreakSamples {
  int count;
  glm::dvec2 pace;  ///< texels, whole along the direction's larger axis
  glm::dvec3 gain, falloff;
};
inline constexpr int kMaxStreakPasses = 6;

/// Kawase's passes (GDC 2003): pass p adds up samples 0, 1, 2, 3 times 4^p steps away, weighted a^(4^p s), so that all together
/// sample 0 ... 4^passes - 1 steps away, weighted a^k. A step is one texel along the direction's larger axis; between the texels
/// of the other axis samples are interpolated by Catmull and Rom's cubic, which moves a picture without blurring it.
/// `log_per_texel`: ln a per texel of length; `gain`: multiplies the last pass.
std::vector<StreakSamples> streak_passes(const glm::dvec2& direction, const glm::dvec3& log_per_texel, int passes,
                                         const glm::dvec3& gain);

/// Sum of those passes' weights by the trapezoidal rule, which counts the first sample half; per channel.
glm::dvec3 streak_sum(const glm::dvec2& direction, const glm::dvec3& log_per_texel, int passes);

/// How far from highlights of so much excess (sum over texels) anything is worth drawing; in texels.
struct GlareReach {
  double bloom_texels, streak_texels;
};
GlareReach glare_reach(const GlareSettings& settings, double rows_per_height, double excess);

/// The level of the bloom's pyramid that streaks are drawn at, 0: the grid itself, and how much blur they need there beside the
/// pyramid's own (variance in texels squared of that level): as coarse as their width and their fall allow.
struct StreakGrid {
  int level;
  double own_blur;
};
StreakGrid streak_grid(const GlareSettings& settings, double rows_per_height);

/// Passes whose 4^passes steps reach so far, unless set by hand.
int streak_pass_count(const GlareSettings& settings, double reach_texels);

/// Streaks in several directions: the passes of each, all equally many, and what the source itself gets besides, which is half
/// of the first samples taken off.
struct Star {
  std::vector<std::vector<StreakSamples>> arms;
  glm::dvec3 at_source;
};
/// A star of settings.streak_strength, on a grid of so many rows a height, that reaches so far on it.
Star plan_star(const GlareSettings& settings, int directions, double rows_per_height, double reach_texels);

/// How far the glare of a frame goes, and where its streaks are drawn.
struct GlareSpread {
  PixelRect texels;  ///< of the grid
  double streak_reach_texels;
  StreakGrid streaks;
};
/// The spread of an excess that lies within the texels `light` and sums up to `excess`. `divided`: streaks differ by where the
/// light comes from, and are drawn on the grid itself.
GlareSpread plan_spread(const GlareSettings& settings, const GlareGrid& grid, int frame_height, const PixelRect& light,
                        double excess, bool divided);

/// A streak's attenuation per texel of the classic look's 128, from that per pixel at 480 rows.
double classic_attenuation(double attenuation_at_480_rows);

}  // namespace catchlight::render
