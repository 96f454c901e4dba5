#include "render/cpu/tone/cpu_tone.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "catchlight/util/parallel.hpp"

namespace catchlight::render {
namespace {

constexpr int kRowsPerTask = 64;
constexpr float kMaxLight = 1e9f;

float sane(float light) {
  return std::isnan(light) ? 0 : std::clamp(light, -kMaxLight, kMaxLight);
}

/// Divides the rows of a frame into tasks: calls work(task, first row, the row after the last) for each.
template <typename Work>
void by_rows(int rows, const Work& work) {
  parallel_for(static_cast<std::size_t>((rows + kRowsPerTask - 1) / kRowsPerTask), 0, [&](std::size_t task) {
    const int first = static_cast<int>(task) * kRowsPerTask;
    work(task, first, std::min(first + kRowsPerTask, rows));
  });
}

}  // namespace

LuminanceHistogram measure_luminances(const Image& light, const glm::dvec3& luminance_weights) {
  const Float4 weights = float4(luminance_weights);
  std::vector<LuminanceHistogram> parts(static_cast<std::size_t>(light.height) / kRowsPerTask + 1);
  by_rows(light.height, [&](std::size_t task, int first, int end) {
    for (int y = first; y < end; ++y)
      for (int x = 0; x < light.width; ++x) {
        const float* rgba = light.pixel(x, y);
        parts[task].add(weights[0] * rgba[0] + weights[1] * rgba[1] + weights[2] * rgba[2]);
      }
  });
  LuminanceHistogram histogram;
  for (const LuminanceHistogram& part : parts) histogram.add(part);
  return histogram;
}

CpuTone::CpuTone(const CompositorSettings& settings) : settings_(settings.tone) {
  if (settings.look == Look::classic && settings.glare.enabled) classic_.emplace(settings.glare);
}

ToneCurve CpuTone::meter(const Image& light, const PlateColor& color) const {
  if (!settings_.enabled) return {};
  return tone_curve(scene_luminance(measure_luminances(light, luminance_weights(color.plate_from_rec709))), settings_);
}

void CpuTone::apply(Image& light, const PlateColor& color, const ToneCurve& curve, bool codes_end_at_1) {
  if (classic_) classic_->draw(light);
  const glm::vec3 weights(luminance_weights(color.plate_from_rec709));
  by_rows(light.height, [&](std::size_t, int first, int end) {
    std::vector<Float4> glare(static_cast<std::size_t>(light.width));
    for (int y = first; y < end; ++y) {
      std::fill(glare.begin(), glare.end(), Float4{});
      if (classic_) classic_->add_to_row(y, glare.data());
      for (int x = 0; x < light.width; ++x) {
        float* rgba = light.pixel(x, y);
        const Float4 added = glare[static_cast<std::size_t>(x)];
        const glm::vec3 scene(sane(rgba[0]) + added[0], sane(rgba[1]) + added[1], sane(rgba[2]) + added[2]);
        const glm::vec3 toned = curve(scene, weights, codes_end_at_1);
        for (int c = 0; c < 3; ++c) {
          const double code = code_from_linear(color, toned[c], c);
          rgba[c] = static_cast<float>(codes_end_at_1 ? std::clamp(code, 0.0, 1.0) : code);
        }
        rgba[3] = 1;
      }
    }
  });
}

}  // namespace catchlight::render
