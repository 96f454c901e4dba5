#include "app/tools/probe_merge/radiance_map.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/response.hpp"
#include "catchlight/util/parallel.hpp"

namespace catchlight::app {
namespace {

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double window(double code) {
  return smooth_step(0.01, 0.04, code) * (1 - smooth_step(0.90, kClippingCode, code));
}

/// The light that one code stands for at exposure 1, and how far it is to be trusted.
struct CodeValue {
  double light, weight;
};

std::vector<CodeValue> code_values(const std::vector<double>& curve) {
  const std::size_t last = curve.size() - 1;
  std::vector<CodeValue> values(curve.size());
  for (std::size_t code = 0; code <= last; ++code) {
    const std::size_t before = code > 0 ? code - 1 : 0, after = std::min(code + 1, last);
    const double step = (curve[after] - curve[before]) / static_cast<double>(after - before);
    const double least_step = 1e-6 * curve[last];  // a flat piece tells no more than this
    values[code] = {curve[code],
                    window(static_cast<double>(code) / static_cast<double>(last)) / std::pow(std::max(step, least_step), 2)};
  }
  return values;
}

class BracketMerger {
 public:
  BracketMerger(const Bracket& bracket, const LightOfCodes& response) : bracket_(bracket) {
    for (int c = 0; c < 3; ++c) values_[c] = code_values(response[c]);
  }

  /// Radiance of one channel; sets `clipped` where it is only a lower bound.
  double radiance(int x, int y, int channel, bool& clipped) const {
    double sum = 0, weights = 0;
    for (const Photograph& photograph : bracket_) {
      const CodeValue value = values_[channel][code(photograph, x, y, channel)];
      const double exposure = photograph.exposure_s;
      sum += value.weight * exposure * value.light;
      weights += value.weight * exposure * exposure;
    }
    if (weights > 0) return sum / weights;
    // Black in all, or clipped in one and black in the next: the longest that is not clipped says most.
    for (const Photograph& photograph : bracket_) {
      const std::size_t at = code(photograph, x, y, channel);
      if (static_cast<double>(at) < kClippingCode * photograph.max_code())
        return values_[channel][at].light / photograph.exposure_s;
    }
    clipped = true;
    return values_[channel].back().light / bracket_.back().exposure_s;
  }

 private:
  static std::size_t code(const Photograph& photograph, int x, int y, int channel) {
    const int blue_first = 3 * x + 2 - channel;
    return photograph.codes.depth() == CV_8U ? photograph.codes.ptr<std::uint8_t>(y)[blue_first]
                                             : photograph.codes.ptr<std::uint16_t>(y)[blue_first];
  }

  const Bracket& bracket_;
  std::array<std::vector<CodeValue>, 3> values_;
};

}  // namespace

RadianceMap merge_bracket(const Bracket& bracket, const LightOfCodes& response) {
  const cv::Size size = bracket.front().codes.size();
  RadianceMap map{Image(size.width, size.height), std::vector<std::uint8_t>(size.area()), 0};
  const BracketMerger merger(bracket, response);
  parallel_for(size.height, 0, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      bool clipped = false;
      for (int c = 0; c < 3; ++c) map.image.pixel(x, y)[c] = static_cast<float>(merger.radiance(x, y, c, clipped));
      map.clipped[row * size.width + x] = clipped;
    }
  });
  map.clipped_share = static_cast<double>(std::count(map.clipped.begin(), map.clipped.end(), 1)) / size.area();
  return map;
}

RadianceMap radiance_of(Image image) {
  RadianceMap map{Image(image.width, image.height),
                  std::vector<std::uint8_t>(static_cast<std::size_t>(image.width) * image.height), 0};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float value = image.pixel(x, y)[c];
        map.image.pixel(x, y)[c] = std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
      }
  return map;
}

}  // namespace catchlight::app
