// Glare by convolution: what exceeds the sensor's white, at the frame's own resolution, with an aperture's point-spread function
// or with the kernel that the fast passes stand for. Offline quality: seconds a frame. No GL needed.
#pragma once

#include <memory>
#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/glare/aperture_picture.hpp"
#include "render/glare/aperture_psf.hpp"
#include "render/math/fft_convolution.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

/// What of `object` (RGBA or RGB, exposed linear, the frame's pixels of `rect`) glares, on the whole frame: the fast passes' gate
/// and compression (shaders/glare_bright.frag) over 5 x 5 pixels instead of 5 x 5 texels of their grid. Empty where nothing does.
std::optional<Image> excess_of(const Image& object, const PixelRect& rect, int frame_width, int frame_height,
                               const GlareSettings& settings);

/// The rectangle around all pixels of an RGB picture that are not 0.
PixelRect lit_pixels(const Image& picture);

class FftGlare {
 public:
  /// Throws Error where settings.aperture cannot be used.
  explicit FftGlare(const GlareSettings& settings);

  /// Light that is added to the frame, for an excess of the camera's own frame size, and 0 where a quarter of a 12-bit code
  /// cannot show it. With an aperture: settings.aperture_strength times the excess convolved with the point-spread function
  /// without its middle pixel; without: the excess convolved with glare_kernel(). The kernel is made anew where the camera is
  /// another.
  Image spread(const Image& excess, const CameraModel& camera);

 private:
  void prepare(const CameraModel& camera);
  Image aperture_kernel(const CameraModel& camera, double focal_px) const;

  GlareSettings settings_;
  std::optional<AperturePicture> picture_;  ///< none: the kernel is glare_kernel()'s closed form
  std::unique_ptr<FftConvolution> convolution_;
  int width_px_ = 0, height_px_ = 0;
  double focal_px_ = 0;
};

}  // namespace catchlight::render
