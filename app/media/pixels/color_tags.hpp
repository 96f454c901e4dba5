// What a frame's colour tags mean in numbers. Private to app/media.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>

#include "app/media/pixels/pixel_layout.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {

/// The transfer function and primaries that the tags declare; see Frame::color().
PlateColor plate_color(const AVFrame& picture);

/// Tagged full range, or a format that is full range where nothing is said (RGB, grey).
bool is_full_range(const AVFrame& picture, const PixelLayout& layout);

/// An RGB code within 0 to 1; what is not a number becomes black rather than undefined.
inline float code_of(float code) {
  return std::min(std::max(0.0f, code), 1.0f);
}

/// RGB codes (0..1) to the format's integer codes: Y Cb Cr, R G B, or Y alone. ITU-R BT.601, BT.709, BT.2020 (non-constant
/// luminance), H.273.
class CodeFromRgb {
 public:
  CodeFromRgb(const AVFrame& picture, const PixelLayout& layout);

  /// Unrounded codes; unclamped.
  glm::dvec3 operator()(const glm::dvec3& rgb) const { return matrix_ * rgb + offset_; }

  /// The same for a row of RGBA pixels, each kept within 0 to 1 first; a pointer a component.
  void row(const float* rgba, int count, const std::array<float*, 3>& codes) const;

  double max_code() const { return max_code_; }

 private:
  glm::dmat3 matrix_{0.0};
  glm::dvec3 offset_{0.0};
  double max_code_;
};

}  // namespace catchlight::app
