// The places of the samples of a pixel format, for every format whose samples are whole bytes. Private to app/media.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

struct AVFrame;

namespace catchlight::app {

enum class ColorModel { gray, yuv, rgb };

/// One colour component. A sample is read from 1 byte (depth 8), 2 bytes (integers up to 16 bits) or 4 (float).
struct Component {
  int plane = 0, step_bytes = 1, offset_bytes = 0, shift = 0, depth = 8;
};

/// Colour components only (alpha is never touched): Y; Y Cb Cr; or R G B.
struct PixelLayout {
  ColorModel model = ColorModel::gray;
  bool is_float = false, big_endian = false;
  int chroma_shift_x = 0, chroma_shift_y = 0;  ///< log2 of the pixels that share a chroma sample
  std::array<Component, 3> components;

  bool is_subsampled() const { return chroma_shift_x != 0 || chroma_shift_y != 0; }
  int depth() const { return components[0].depth; }
  int max_code() const { return is_float ? 1 : (1 << depth()) - 1; }
};

/// None for palettes, bit-packed, Bayer, hardware and other formats that a source has to convert first.
std::optional<PixelLayout> pixel_layout(int format);

/// Reads and writes one component's codes (integers) in a frame; coordinates are samples of that component.
class SamplePlane {
 public:
  SamplePlane(const AVFrame& frame, const PixelLayout& layout, int component);

  int code(int x, int y) const {
    const std::uint8_t* at = address(x, y);
    return static_cast<int>((wide_ ? wide_code(at) : *at) >> component_.shift & mask_);
  }
  void set_code(int x, int y, int value) const;

  /// Sets the codes of those of `count` samples from column `x` on that changed (1), rounded and kept within what the depth has.
  void set_codes(int x, int y, const float* codes, const std::uint8_t* changed, int count) const;

  float value(int x, int y) const {
    float value;
    std::memcpy(&value, address(x, y), sizeof value);
    return value;
  }
  void set_value(int x, int y, float value) const { std::memcpy(address(x, y), &value, sizeof value); }

 private:
  std::uint8_t* address(int x, int y) const {
    return data_ + static_cast<std::ptrdiff_t>(y) * stride_bytes_ + static_cast<std::ptrdiff_t>(x) * component_.step_bytes;
  }
  unsigned wide_code(const std::uint8_t* at) const {
    return big_endian_ ? static_cast<unsigned>(at[0] << 8 | at[1]) : static_cast<unsigned>(at[1] << 8 | at[0]);
  }

  std::uint8_t* data_;
  std::ptrdiff_t stride_bytes_;
  Component component_;
  unsigned mask_;
  bool wide_, big_endian_;
};

}  // namespace catchlight::app
