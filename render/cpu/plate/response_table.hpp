// Codes to light and back for many pixels: catchlight/response's functions, looked up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "catchlight/plate.hpp"
#include "render/cpu/plate/plate_block.hpp"
#include "render/math/float4.hpp"

namespace catchlight::render {

class ResponseTable {
 public:
  using Tables = std::array<std::vector<float>, 3>;

  /// Makes the tables anew only for another response or format.
  void set(const CameraResponse& response, Plate::Format format);

  /// A pixel's light, and 0; what is not finite in the plate is black. `plate` must have the format of the tables.
  Float4 linear(const Plate& plate, std::size_t pixel) const {
    return plate.format == Plate::Format::rgb_f32 ? linear_of_floats(plate, pixel) : looked_up(linear_, plate, pixel);
  }

  /// The light of each integer code, red first; nothing where codes are floats.
  const Tables& linear_of_codes() const { return linear_; }

  /// What `tables` have for a pixel's integer codes, and 0.
  static Float4 looked_up(const Tables& tables, const Plate& plate, std::size_t pixel) {
    if (plate.format == Plate::Format::rgb_u8) return looked_up<std::uint8_t>(tables, plate, pixel);
    return looked_up<std::uint16_t>(tables, plate, pixel);
  }

  /// The codes of `count` pixels of a block, and their light too.
  void read(const Plate& plate, std::size_t first_pixel, int count, Planes& codes) const;
  void read(const Plate& plate, std::size_t first_pixel, int count, Planes& codes, Planes& linear) const;

  /// The codes of a channel's light, to a 20 000th of a code's range between 0 and 16; exact beyond and for curves from tables.
  void code(const Planes& linear, int channel, int count, Planes& codes) const;

 private:
  template <typename Code>
  static std::array<Code, 3> triple(const Plate& plate, std::size_t pixel) {
    std::array<Code, 3> codes;
    std::memcpy(codes.data(), plate.pixels.data() + pixel * sizeof(codes), sizeof(codes));
    return codes;
  }

  template <typename Code>
  static Float4 looked_up(const Tables& tables, const Plate& plate, std::size_t pixel) {
    const auto code = triple<Code>(plate, pixel);
    return Float4{tables[0][code[0]], tables[1][code[1]], tables[2][code[2]], 0};
  }

  template <typename Code>
  void look_up(const Plate& plate, std::size_t first_pixel, int count, Planes& codes, Planes* linear) const;
  Float4 linear_of_floats(const Plate& plate, std::size_t pixel) const;
  float exact_code(float linear, int channel) const;

  std::optional<CameraResponse> response_;
  Plate::Format format_ = Plate::Format::rgb_u8;
  Tables linear_, codes_;       ///< a value an integer code, red first
  std::vector<float> inverse_;  ///< empty for a curve
};

}  // namespace catchlight::render
