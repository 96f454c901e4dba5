#include "render/glare/fft_glare.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/glare/glare_kernel.hpp"

namespace catchlight::render {
namespace {

constexpr int kGateReach_px = 2;
constexpr std::array<float, 2 * kGateReach_px + 1> kBinomial = {0.0625f, 0.25f, 0.375f, 0.25f, 0.0625f};
/// The least light that shows: a quarter of a code of 12 bits near black.
constexpr float kVisible = 0.25f / 4095 / 12.92f;
constexpr float kBrightestPixel = 1e9f;

float usable(float light) {
  return light > 0 ? std::min(light, kBrightestPixel) : 0.0f;  // NaN is not above 0
}

/// Brightest channel of every pixel.
Image peaks_of(const Image& object) {
  Image peaks(object.width, object.height, 1);
  for (int y = 0; y < object.height; ++y)
    for (int x = 0; x < object.width; ++x) {
      const float* rgb = object.pixel(x, y);
      *peaks.pixel(x, y) = std::max({usable(rgb[0]), usable(rgb[1]), usable(rgb[2])});
    }
  return peaks;
}

struct Gate {
  float highest = 0, mean = 0;
};

Gate around(const Image& peaks, int x, int y) {
  Gate gate;
  for (int v = std::max(-kGateReach_px, -y); v <= std::min(kGateReach_px, peaks.height - 1 - y); ++v)
    for (int u = std::max(-kGateReach_px, -x); u <= std::min(kGateReach_px, peaks.width - 1 - x); ++u) {
      const float peak = *peaks.pixel(x + u, y + v);
      gate.highest = std::max(gate.highest, peak);
      gate.mean +=
          kBinomial[static_cast<std::size_t>(u + kGateReach_px)] * kBinomial[static_cast<std::size_t>(v + kGateReach_px)] * peak;
    }
  return gate;
}

/// GLSL's smoothstep().
double smoothstep(double low, double high, double value) {
  const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

std::optional<Image> excess_of(const Image& object, const PixelRect& rect, int frame_width, int frame_height,
                               const GlareSettings& settings) {
  const Image peaks = peaks_of(object);
  const double threshold = std::max(settings.threshold, 1e-6);
  if (std::none_of(peaks.data.begin(), peaks.data.end(), [&](float peak) { return peak > threshold; })) return {};
  Image excess(frame_width, frame_height);
  const PixelRect shown = intersect(rect, {0, 0, frame_width, frame_height});
  for (int y = shown.y; y < shown.y + shown.height; ++y)
    for (int x = shown.x; x < shown.x + shown.width; ++x) {
      const Gate gate = around(peaks, x - rect.x, y - rect.y);
      const double kept = smoothstep(threshold, 1.5 * threshold, gate.highest) / (1 + gate.mean / settings.brightest);
      const float* rgb = object.pixel(x - rect.x, y - rect.y);
      for (int c = 0; c < 3; ++c) excess.pixel(x, y)[c] = static_cast<float>(usable(rgb[c]) * kept);
    }
  return excess;
}

PixelRect lit_pixels(const Image& picture) {
  int left = picture.width, right = -1, top = picture.height, bottom = -1;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const float* rgb = picture.pixel(x, y);
      if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = y;
    }
  return right < left ? PixelRect{} : PixelRect{left, top, right - left + 1, bottom - top + 1};
}

FftGlare::FftGlare(const GlareSettings& settings) : settings_(settings) {
  if (settings.aperture != "none") picture_ = aperture_picture(settings.aperture);
}

Image FftGlare::aperture_kernel(const CameraModel& camera, double focal_px) const {
  const ApertureOptics optics{settings_.aperture_mm, focal_px};
  const AperturePlan plan = plan_aperture(optics, std::max(camera.width_px, camera.height_px), picture_->most_px);
  const ApertureFarField field(picture_->draw(plan.picture_px), plan.transform_px);
  Image glare = glare_of(aperture_psf(field, optics, plan.reach_px));
  for (float& value : glare.data) value *= static_cast<float>(settings_.aperture_strength);
  return glare;
}

void FftGlare::prepare(const CameraModel& camera) {
  const double focal_px = std::sqrt(camera.fx_px * camera.fy_px);
  if (convolution_ && camera.width_px == width_px_ && camera.height_px == height_px_ && focal_px == focal_px_) return;
  const Image kernel = picture_ ? aperture_kernel(camera, focal_px)
                                : glare_kernel(settings_, camera.height_px, 2 * camera.width_px - 1, 2 * camera.height_px - 1);
  convolution_ = std::make_unique<FftConvolution>(kernel, camera.width_px, camera.height_px);
  width_px_ = camera.width_px, height_px_ = camera.height_px, focal_px_ = focal_px;
}

Image FftGlare::spread(const Image& excess, const CameraModel& camera) {
  prepare(camera);
  Image glare = convolution_->convolve(excess);
  for (std::size_t i = 0; i < glare.data.size(); i += 3) {
    float* rgb = &glare.data[i];
    if (std::max({rgb[0], rgb[1], rgb[2]}) < kVisible) std::fill_n(rgb, 3, 0.0f);
    for (int c = 0; c < 3; ++c) rgb[c] = std::max(rgb[c], 0.0f);  // what rounding leaves below
  }
  return glare;
}

}  // namespace catchlight::render
