// The footage's pixels, and how they code light.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/raw_vector.hpp"

namespace catchlight {

/// Part of the footage's frame: RGB codes, row-major. Integers are full scale (255 or 65535 = code 1); floats are codes as they
/// are.
struct Plate {
  enum class Format { rgb_u8, rgb_u16, rgb_f32 };
  PixelRect rect;
  Format format = Format::rgb_u8;
  RawVector<std::byte> pixels;
};

/// Gives the requested part of the current frame; called only for what the virtual layer reaches.
using PlateReader = std::function<Plate(const PixelRect&)>;

/// How the footage codes light: the camera's response, and its primaries.
struct PlateColor : CameraResponse {
  glm::mat3 plate_from_rec709{1.0f};  ///< linear
};

/// The plate's codes as bytes, row-major; what is beyond 0 and 1 is cut off.
std::vector<unsigned char> codes_8_bit(const Plate& plate);

/// The plate's light as RGB triples, row-major, Rec. 709 primaries; 1 = sensor white.
RawVector<float> linear_rgb(const Plate& plate, const PlateColor& color);

/// Light of the clipping level, a channel each. Infinite for float plates, which do not clip.
glm::dvec3 clipping_linear(Plate::Format format, const PlateColor& color);

}  // namespace catchlight
