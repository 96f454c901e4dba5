// The footage's pixels, and how they code light.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "catchlight/color.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/response_curve.hpp"

namespace catchlight {

/// Part of the footage's frame: RGB codes, row-major. Integers are full scale (255 or 65535 = code 1); floats are codes as they
/// are.
struct Plate {
  enum class Format { rgb_u8, rgb_u16, rgb_f32 };
  PixelRect rect;
  Format format = Format::rgb_u8;
  std::vector<std::byte> pixels;
};

/// Gives the requested part of the current frame; called only for what the virtual layer reaches.
using PlateReader = std::function<Plate(const PixelRect&)>;

/// How the footage codes light.
struct PlateColor {
  TransferFunction transfer = TransferFunction::srgb;
  glm::mat3 plate_from_rec709{1.0f};                ///< linear primaries conversion
  std::shared_ptr<const ResponseCurve> curve = {};  ///< stands in for `transfer`
};

}  // namespace catchlight
