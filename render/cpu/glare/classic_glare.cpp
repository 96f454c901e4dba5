#include "render/cpu/glare/classic_glare.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/color.hpp"

namespace catchlight::render {
namespace {

constexpr int kSize = 512, kStreakSize = 128, kStreakPasses = 3;
constexpr float kBrightestPixel = 1e9f;
constexpr std::array<glm::ivec2, 4> kDiagonals{{{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};

/// One side of a Gaussian of 3 texels, 15 taps of unit sum.
std::vector<double> blur_taps() {
  std::vector<double> taps;
  double sum = 0;
  for (int d = 0; d <= 7; ++d) {
    taps.push_back(std::exp(-d * d / 18.0));
    sum += taps.back() * (d == 0 ? 1 : 2);
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

/// What of a pixel's light is over the threshold of luminance.
Float4 excess(const float* rgba, float threshold) {
  static const Float4 weights = float4(kLuminanceWeights);
  const Float4 light = at_most(positive(load(rgba)), Float4{kBrightestPixel, kBrightestPixel, kBrightestPixel, 0});
  const Float4 parts = weights * light;
  const float luminance = parts[0] + parts[1] + parts[2];
  return luminance > threshold ? (luminance - threshold) / luminance * light : Float4{};
}

/// Half the size: the mean of 2 x 2 texels.
void shrink(const GlarePicture& from, GlarePicture& to) {
  to.clear();
  for (int y = 0; y < to.rows(); ++y) {
    GlarePicture pair(from.columns(), 1);
    for (const int row : {2 * y, 2 * y + 1}) pair.add(0, from, row, 0, splat(0.25), from.all_columns());
    const Span lit = pair.lit(0), span{lit.begin / 2, (lit.end + 1) / 2};
    if (lit.empty()) continue;
    const Float4* texels = pair.widen(0, {2 * span.begin, 2 * span.end});
    Float4* row = to.widen(y, span);
    for (int x = span.begin; x < span.end; ++x) row[x] = texels[2 * x] + texels[2 * x + 1];
  }
}

}  // namespace

ClassicGlare::ClassicGlare(const GlareSettings& settings)
    : settings_(settings), bloom_(kSize, kSize), streaks_(kStreakSize, kStreakSize), texel_line_(kSize, 1) {
  for (std::size_t i = 0; i < bright_.size(); ++i) {
    const int size = kSize >> i;
    const GlarePicture picture(size, size);
    bright_[i] = {picture, picture, picture, linear_samples(kSize, size)};
  }
}

void ClassicGlare::resize(int width, int height) {
  width_ = width, height_ = height;
  pixel_line_ = GlarePicture(width, 1);
  columns_of_bloom_ = linear_samples(width, kSize), rows_of_bloom_ = linear_samples(height, kSize);
  columns_of_streaks_ = linear_samples(width, kStreakSize), rows_of_streaks_ = linear_samples(height, kStreakSize);
}

void ClassicGlare::draw(const Image& light) {
  if (light.width != width_ || light.height != height_) resize(light.width, light.height);
  find_bright(light);
  for (std::size_t i = 1; i < bright_.size(); ++i) shrink(bright_[i - 1].picture, bright_[i].picture);
  make_bloom();
  make_streaks();
}

/// Averages what is over the threshold over each texel's part of the picture (shaders/classic_bright.frag).
void ClassicGlare::find_bright(const Image& light) {
  GlarePicture& bright = bright_[0].picture;
  bright.clear();
  const auto threshold = static_cast<float>(settings_.threshold);
  const double across = static_cast<double>(width_) / kSize, down = static_cast<double>(height_) / kSize;
  for (int y = 0; y < height_; ++y) {
    // No luminance is above its highest channel, but for rounding.
    if (!any_above(light.pixel(0, y), width_, threshold * (1 - 1e-6f))) continue;
    pixel_line_.clear();
    Float4* pixels = pixel_line_.widen(0, pixel_line_.all_columns());
    for (int x = 0; x < width_; ++x) pixels[x] = excess(light.pixel(x, y), threshold);
    texel_line_.clear();
    Float4* texels = texel_line_.widen(0, texel_line_.all_columns());
    for (int t = 0; t < kSize; ++t) {
      const double first = t * across, last = first + across;
      for (int x = static_cast<int>(first); x < width_ && x < last; ++x)
        texels[t] += static_cast<float>((std::min(x + 1.0, last) - std::max<double>(x, first)) / across) * pixels[x];
    }
    for (int t = static_cast<int>(y / down); t < kSize && t * down < y + 1; ++t) {
      const double part = std::min(y + 1.0, (t + 1) * down) - std::max<double>(y, t * down);
      if (part > 0) bright.add(t, texel_line_, 0, 0, splat(part / down), bright.all_columns());
    }
  }
}

/// Lays three sizes over each other, the smaller ones bilinearly.
void ClassicGlare::make_bloom() {
  static const std::vector<double> taps = blur_taps();
  bloom_.clear();
  for (const std::size_t i : {0, 1, 3}) {
    Size& size = bright_[i];
    size.blurred.clear();
    const int texels = size.picture.rows();
    add_blurred(size.picture, taps, 1, size.half_blurred, size.blurred, {0, 0, texels, texels});
    for (int y = 0; y < kSize; ++y) {
      const LinearSamples& rows = size.at_512[static_cast<std::size_t>(y)];
      if (size.blurred.lit(rows.first).empty() && size.blurred.lit(rows.second).empty()) continue;
      add_between(size.blurred, rows, size.at_512, 1, bloom_.widen(y, bloom_.all_columns()));
    }
  }
}

/// Kawase's passes along the picture's diagonals; four samples each, 1, 4 and 16 texels apart.
void ClassicGlare::make_streaks() {
  const GlarePicture& source = bright_[2].picture;
  const PixelRect all{0, 0, kStreakSize, kStreakSize};
  const double attenuation = classic_attenuation(settings_.streak_attenuation);
  streaks_.clear();
  for (const glm::ivec2& diagonal : kDiagonals) {
    const GlarePicture* from = &source;
    for (int pass = 0; pass < kStreakPasses; ++pass) {
      const bool is_last = pass + 1 == kStreakPasses;
      const int step = 1 << (2 * pass);
      GlarePicture& to = is_last ? streaks_ : between_[static_cast<std::size_t>(pass)];
      if (!is_last) fit(to, source);
      add_streak_pass(*from,
                      {4, glm::dvec2(diagonal * step), glm::dvec3(is_last ? 1.0 / kDiagonals.size() : 1.0),
                       glm::dvec3(std::pow(attenuation, step))},
                      to, all);
      from = &to;
    }
  }
}

void ClassicGlare::add_to_row(int y, Float4* row) const {
  const auto i = static_cast<std::size_t>(y);
  add_between(bloom_, rows_of_bloom_[i], columns_of_bloom_, static_cast<float>(settings_.bloom_strength), row);
  add_between(streaks_, rows_of_streaks_[i], columns_of_streaks_, static_cast<float>(settings_.streak_strength), row);
}

}  // namespace catchlight::render
