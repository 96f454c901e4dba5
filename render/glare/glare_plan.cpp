#include "render/glare/glare_plan.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "shaders/interface.h"

namespace catchlight::render {
namespace {

/// A streak's attenuation is stated per pixel of a frame of so many rows.
constexpr double kReferenceRows = 480.0;
constexpr double kNarrowest_heights = 0.006, kFalloff = 0.65;
/// Variance of the filter that halves the resolution, (1 3 3 1) / 8, of bilinear reading, and of the cubic B-spline that goes up
/// to the grid; texels squared.
constexpr double kDownVariance = 0.75, kUpVariance = 3.0 / 16.0, kUpToGridVariance = 1.0 / 3.0;
/// The narrowest Gaussian makes most of the bloom's peak: a level's own blur is at least as wide as this (texels squared), so
/// that its texels do not show. The others, and a streak, fainter where it is sharp, may do without.
constexpr double kMinBlurOfNarrowest = 1.0;
/// What blurs less than this (texels squared) is left out: with 240 rows at most 0.018 would be.
constexpr double kNegligibleBlur = 0.05;
/// A streak's steps are at most so long: what is left after one is above exp(-0.6). Coarser steps show in its profile.
constexpr double kLongestStep = 0.6;
/// The least light worth drawing: a quarter of an 8-bit sRGB code in black is 7.6e-5.
constexpr double kInvisible = 2e-5;

/// The variance that going down to a level and up again adds; texels squared of level 0.
double pyramid_variance(int level) {
  double variance = 0;
  for (int k = 0; k < level; ++k) variance += std::exp2(2 * k) * (kDownVariance + 4 * (k == 0 ? kUpToGridVariance : kUpVariance));
  return variance;
}

double length_of_step(const glm::dvec2& direction) {
  return 1 / std::max(std::abs(direction.x), std::abs(direction.y));
}

}  // namespace

GlareGrid make_glare_grid(int frame_width, int frame_height, int wanted_rows) {
  const double texel_px = std::max(1.0, static_cast<double>(frame_height) / wanted_rows);
  const auto texels = [&](int pixels) {
    return std::max(1, static_cast<int>(std::ceil(pixels / texel_px - 1e-9))) + 2 * GLARE_MARGIN;
  };
  return {texel_px, texels(frame_width), texels(frame_height)};
}

GlareGrid GlareGrid::halved(int times) const {
  const int step = 1 << times;
  const auto texels = [&](int all) { return (all - 2 * GLARE_MARGIN + step - 1) / step + 2 * GLARE_MARGIN; };
  return {texel_px * step, texels(columns), texels(rows)};
}

PixelRect GlareGrid::texels(const PixelRect& pixels, int more) const {
  const auto low = [&](int px) { return static_cast<int>(std::floor(px / texel_px)) + GLARE_MARGIN - more; };
  const auto high = [&](int px) { return static_cast<int>(std::ceil(px / texel_px)) + GLARE_MARGIN + more; };
  const int x = low(pixels.x), y = low(pixels.y);
  return intersect({x, y, high(pixels.x + pixels.width) - x, high(pixels.y + pixels.height) - y}, {0, 0, columns, rows});
}

PixelRect GlareGrid::pixels(const PixelRect& texels) const {
  const int x = static_cast<int>(std::floor((texels.x - GLARE_MARGIN) * texel_px)),
            y = static_cast<int>(std::floor((texels.y - GLARE_MARGIN) * texel_px));
  return {x, y, static_cast<int>(std::ceil((texels.x + texels.width - GLARE_MARGIN) * texel_px)) - x,
          static_cast<int>(std::ceil((texels.y + texels.height - GLARE_MARGIN) * texel_px)) - y};
}

PixelRect texels_at(const PixelRect& texels, const GlareGrid& grid, int level, int around) {
  const double step = std::exp2(level);
  const auto low = [&](int t) { return static_cast<int>(std::floor((t - GLARE_MARGIN) / step)) + GLARE_MARGIN - around; };
  const auto high = [&](int t) { return static_cast<int>(std::ceil((t - GLARE_MARGIN) / step)) + GLARE_MARGIN + around; };
  const int x = low(texels.x), y = low(texels.y);
  return intersect({x, y, high(texels.x + texels.width) - x, high(texels.y + texels.height) - y}, grid.halved(level).all());
}

std::array<BloomGaussian, kBloomGaussians> bloom_gaussians() {
  std::array<BloomGaussian, kBloomGaussians> result{};
  double weight = (1 - kFalloff) / (1 - std::pow(kFalloff, kBloomGaussians)), sigma = kNarrowest_heights;
  for (BloomGaussian& gaussian : result) {
    gaussian = {weight, sigma};
    weight *= kFalloff;
    sigma *= 2;
  }
  return result;
}

std::vector<double> gaussian_taps(double variance) {
  // So narrow a Gaussian is no longer told by samples at the texels' centres: three taps of its variance.
  if (variance <= 0) return {1};
  if (variance < 0.25) return {1 - variance, 0.5 * variance};
  const int radius = std::clamp(static_cast<int>(std::ceil(3.2 * std::sqrt(variance))), 1, MAX_GLARE_BLUR_TAPS - 1);
  std::vector<double> taps;
  double sum = 0;
  for (int d = 0; d <= radius; ++d) {
    taps.push_back(std::exp(-d * d / (2 * variance)));
    sum += taps.back() * (d == 0 ? 1 : 2);
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

namespace {

/// The blur that a level needs of its own for a Gaussian of that variance; both in texels squared, of the level and of level 0.
double own_blur(double variance, int level) {
  const double blur = (variance - pyramid_variance(level)) / std::exp2(2 * level);
  return std::abs(blur) < kNegligibleBlur ? 0 : blur;
}

int coarsest_level(double variance, double least_blur) {
  int level = 0;
  while (own_blur(variance, level + 1) >= least_blur) ++level;
  return level;
}

}  // namespace

std::vector<BloomBlur> plan_bloom(double rows_per_height) {
  std::vector<BloomBlur> blurs;
  for (const BloomGaussian& gaussian : bloom_gaussians()) {
    const double variance = std::pow(gaussian.sigma_heights * rows_per_height, 2);
    const int level = coarsest_level(variance, blurs.empty() ? kMinBlurOfNarrowest : 0);
    blurs.push_back({level, gaussian.weight, gaussian_taps(own_blur(variance, level))});
  }
  return blurs;
}

glm::dvec3 streak_log_per_height(const GlareSettings& settings) {
  // Diffraction spreads light in proportion to its wavelength; red, green and blue of Rec. 709 around 610, 550 and 465 nm.
  const glm::dvec3 longer = glm::dvec3(610, 550, 465) / 550.0 - 1.0;
  const double per_height = kReferenceRows * std::log(std::clamp(settings.streak_attenuation, 1e-6, 0.999));
  return per_height / glm::max(1.0 + settings.streak_dispersion * longer, 0.1);
}

std::vector<glm::dvec2> streak_directions(int count, double rotation_deg) {
  std::vector<glm::dvec2> directions;
  for (int i = 0; i < count; ++i) {
    const double angle = glm::radians(rotation_deg) + glm::two_pi<double>() * i / count;
    directions.emplace_back(std::cos(angle), std::sin(angle));
  }
  return directions;
}

std::vector<StreakSamples> streak_passes(const glm::dvec2& direction, const glm::dvec3& log_per_texel, int passes,
                                         const glm::dvec3& gain) {
  const double length = length_of_step(direction);
  const glm::dvec2 step = direction * length, whole = glm::round(step);
  const auto exact = [](double value, double near) { return std::abs(value - near) < 1e-6 ? near : value; };
  std::vector<StreakSamples> result;
  for (int p = 0; p < passes; ++p) {
    const double steps = std::exp2(2 * p);
    result.push_back({4, steps * glm::dvec2(exact(step.x, whole.x), exact(step.y, whole.y)),
                      p + 1 == passes ? gain : glm::dvec3(1), glm::exp(log_per_texel * length * steps)});
  }
  return result;
}

glm::dvec3 streak_sum(const glm::dvec2& direction, const glm::dvec3& log_per_texel, int passes) {
  const glm::dvec3 log_per_step = log_per_texel * length_of_step(direction);
  return (1.0 - glm::exp(log_per_step * std::exp2(2 * passes))) / (1.0 - glm::exp(log_per_step)) - 0.5;
}

GlareReach glare_reach(const GlareSettings& settings, double rows_per_height, double excess) {
  GlareReach reach{0, 0};
  const double bloom = settings.bloom_strength * excess;
  for (const BloomGaussian& gaussian : bloom_gaussians()) {
    // Each Gaussian may have its share of the invisible.
    const double variance = std::pow(gaussian.sigma_heights * rows_per_height, 2);
    const double peak = bloom * gaussian.weight / (glm::two_pi<double>() * variance) / (kInvisible / kBloomGaussians);
    if (peak > 1) reach.bloom_texels = std::max(reach.bloom_texels, std::sqrt(2 * variance * std::log(peak)));
  }
  const glm::dvec3 logs = streak_log_per_height(settings) / rows_per_height;
  const double slowest = std::max({logs.r, logs.g, logs.b});
  const double peak = settings.streak_strength * excess * -slowest / kInvisible;
  if (peak > 1) reach.streak_texels = std::log(peak) / -slowest;
  return reach;
}

StreakGrid streak_grid(const GlareSettings& settings, double rows_per_height) {
  const double variance = std::pow(settings.streak_width * rows_per_height, 2);
  const glm::dvec3 logs = -streak_log_per_height(settings) / rows_per_height;
  const double steepest = std::max({logs.r, logs.g, logs.b});
  int level = coarsest_level(variance, 0);
  while (level > 0 && steepest * std::exp2(level) * std::sqrt(2) > kLongestStep) --level;
  return {level, own_blur(variance, level)};
}

int streak_pass_count(const GlareSettings& settings, double reach_texels) {
  if (settings.streak_passes > 0) return std::min(settings.streak_passes, kMaxStreakPasses);
  return std::clamp(static_cast<int>(std::ceil(std::log2(std::max(reach_texels, 1.0)) / 2)), 1, kMaxStreakPasses);
}

Star plan_star(const GlareSettings& settings, int directions, double rows_per_height, double reach_texels) {
  const glm::dvec3 log_per_texel = streak_log_per_height(settings) / rows_per_height;
  const int passes = streak_pass_count(settings, reach_texels);
  Star star{{}, glm::dvec3(0)};
  for (const glm::dvec2& direction : streak_directions(directions, settings.streak_rotation_deg)) {
    // Neither their number nor the passes nor the resolution changes the brightness.
    const glm::dvec3 gain = settings.streak_strength / directions / streak_sum(direction, log_per_texel, passes);
    star.arms.push_back(streak_passes(direction, log_per_texel, passes, gain));
    star.at_source -= 0.5 * gain;
  }
  return star;
}

GlareSpread plan_spread(const GlareSettings& settings, const GlareGrid& grid, int frame_height, const PixelRect& light,
                        double excess, bool divided) {
  const double rows_per_height = grid.rows_per_height(frame_height);
  const GlareReach reach = glare_reach(settings, rows_per_height, excess);
  const int grow = static_cast<int>(std::ceil(std::max(reach.bloom_texels, reach.streak_texels)));
  const PixelRect texels{light.x - grow, light.y - grow, light.width + 2 * grow, light.height + 2 * grow};
  StreakGrid streaks = streak_grid(settings, rows_per_height);
  // The two parts of the excess are not in the pyramid.
  if (divided) streaks = {0, std::pow(settings.streak_width * rows_per_height, 2)};
  return {intersect(texels, grid.all()), reach.streak_texels, streaks};
}

double classic_attenuation(double attenuation_at_480_rows) {
  return std::pow(attenuation_at_480_rows, kReferenceRows / 128);
}

}  // namespace catchlight::render
