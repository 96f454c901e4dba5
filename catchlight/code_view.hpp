// A frame's samples as the decoder gave them, of any format, and the RGB codes that they stand for.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <vector>

#include "catchlight/pixel_rect.hpp"

namespace catchlight {

/// The samples of one component: integers of 8 to 16 bits, or floats.
struct SampleView {
  enum class Kind : std::uint8_t { byte, little_endian, big_endian, real };

  const std::uint8_t* data = nullptr;  ///< the first sample
  std::ptrdiff_t stride_bytes = 0;
  int step_bytes = 1;
  Kind kind = Kind::byte;
  int shift = 0;           ///< a wide integer is in its bits from here on
  unsigned mask = 0xffff;  ///< all ones, as many as a wide integer has bits

  float at(int x, int y) const {
    const std::uint8_t* from = data + y * stride_bytes + static_cast<std::ptrdiff_t>(x) * step_bytes;
    switch (kind) {
      case Kind::byte:
        return *from;
      case Kind::little_endian:
        return static_cast<float>(static_cast<unsigned>(from[1] << 8 | from[0]) >> shift & mask);
      case Kind::big_endian:
        return static_cast<float>(static_cast<unsigned>(from[0] << 8 | from[1]) >> shift & mask);
      case Kind::real:
        break;
    }
    float value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }
};

/// A picture's samples: Y Cb Cr, R G B, or grey three times. A pixel's RGB code is that of its own luma with the one colour
/// sample of its block. Codes are normalised: 0 is the stream's black, 1 its white.
struct CodeView {
  int width_px = 0, height_px = 0;
  std::array<SampleView, 3> samples;
  glm::ivec2 block_shift{0};  ///< log2 of the pixels across and down that share a colour sample: (1, 1) in 4:2:0
  glm::mat3 rgb_from_samples{1.0f};
  glm::vec3 rgb_of_zeros{0.0f};
  glm::vec3 luma_weights{1, 0, 0};  ///< the samples' share in luma: what Y holds; of RGB, Rec. 709's luma
  float luma_of_zeros = 0;
  bool is_real = false;      ///< floats, which do not end at 0 and 1
  glm::dmat3 rounding{0.0};  ///< covariance of RGB that comes of rounding to whole codes

  glm::vec3 samples_at(int x, int y) const {
    return {samples[0].at(x, y), samples[1].at(x >> block_shift.x, y >> block_shift.y),
            samples[2].at(x >> block_shift.x, y >> block_shift.y)};
  }
  glm::vec3 rgb(int x, int y) const { return rgb_from_samples * samples_at(x, y) + rgb_of_zeros; }

  /// RGB less luma: the same for every pixel of a block, but in RGB formats.
  glm::vec3 color(int x, int y) const {
    const glm::vec3 here = samples_at(x, y);
    return rgb_from_samples * here + rgb_of_zeros - (glm::dot(luma_weights, here) + luma_of_zeros);
  }

  /// The whole blocks in a part of the picture.
  PixelRect whole_blocks(const PixelRect& rect) const;
};

/// Luma of part of a picture, row-major. The part must lie in it.
std::vector<float> luma_of(const CodeView& view, const PixelRect& rect);

}  // namespace catchlight
