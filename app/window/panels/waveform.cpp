#include "app/window/panels/waveform.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/color.hpp"

namespace catchlight::app {
namespace {

constexpr int kCodes = 256, kCountedPixels = 300'000;
constexpr std::size_t kLuma = 3;
constexpr std::array<std::array<unsigned char, 3>, 4> kColors{{{255, 90, 80}, {100, 220, 100}, {110, 150, 255}, {220, 220, 220}}};

/// Draws one channel's counts into columns from `left` on.
void draw(const Waveform& waveform, std::size_t channel, int left, RgbPicture& picture) {
  const auto& counts = waveform.counts[channel];
  const double most = std::max(1, *std::ranges::max_element(counts));
  for (int code = 0; code < kCodes; ++code)
    for (int column = 0; column < waveform.columns; ++column) {
      const double share = std::pow(waveform.at(channel, code, column) / most, 0.4);
      const auto at = 3 * (static_cast<std::size_t>(kCodes - 1 - code) * static_cast<std::size_t>(picture.width) +
                           static_cast<std::size_t>(left + column));
      for (std::size_t c = 0; c < 3; ++c)
        picture.rgb[at + c] = static_cast<unsigned char>(20 + share * (kColors[channel][c] - 20));
    }
}

RgbPicture empty_picture(int width) {
  return {width, kCodes, std::vector<unsigned char>(static_cast<std::size_t>(3) * kCodes * static_cast<std::size_t>(width))};
}

}  // namespace

Waveform waveform_of(const RgbPicture& picture, int columns) {
  Waveform waveform{columns, {}};
  for (auto& counts : waveform.counts) counts.resize(static_cast<std::size_t>(kCodes) * static_cast<std::size_t>(columns));
  const int step = std::max(1, picture.width * picture.height / kCountedPixels);
  for (int y = 0; y < picture.height; y += step)
    for (int x = 0; x < picture.width; ++x) {
      const unsigned char* rgb =
          &picture.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x))];
      const auto column = static_cast<std::size_t>(x * columns / picture.width);
      const auto count = [&](std::size_t channel, long code) {
        ++waveform.counts[channel][static_cast<std::size_t>(code) * static_cast<std::size_t>(columns) + column];
      };
      for (std::size_t c = 0; c < 3; ++c) count(c, rgb[c]);
      count(kLuma, std::lround(glm::dot(kLuminanceWeights, glm::dvec3(rgb[0], rgb[1], rgb[2]))));
    }
  return waveform;
}

RgbPicture luma_waveform(const Waveform& waveform) {
  RgbPicture picture = empty_picture(waveform.columns);
  draw(waveform, kLuma, 0, picture);
  return picture;
}

RgbPicture rgb_parade(const Waveform& waveform) {
  RgbPicture picture = empty_picture(3 * waveform.columns);
  for (std::size_t c = 0; c < kLuma; ++c) draw(waveform, c, static_cast<int>(c) * waveform.columns, picture);
  return picture;
}

}  // namespace catchlight::app
