// Glare by convolution: the same picture as ApertureGlarePass gives.
#pragma once

#include <optional>

#include "render/cpu/glare/cpu_glare.hpp"
#include "render/glare/fft_glare.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

class ApertureGlare : public CpuGlare {
 public:
  /// Throws Error as FftGlare does.
  explicit ApertureGlare(const GlareSettings& settings) : settings_(settings), convolution_(settings) {}

  /// What is emitted glares as the rest.
  bool extract(const Image& object, const Image* emission, const PixelRect& rect, int frame_width, int frame_height) override;
  PixelRect spread(const CameraModel& camera) override;
  void read_row(int x, int y, int count, float* rgb) const override;

 private:
  GlareSettings settings_;
  FftGlare convolution_;
  std::optional<Image> excess_;
  Image glare_;  ///< of every pixel of the frame
};

}  // namespace catchlight::render
