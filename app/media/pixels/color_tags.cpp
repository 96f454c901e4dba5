#include "app/media/pixels/color_tags.hpp"

#include <algorithm>

extern "C" {
#include <libavutil/frame.h>
}

#include "catchlight/response.hpp"

namespace catchlight::app {
namespace {

struct Primaries {
  glm::dvec2 red, green, blue;
};

constexpr glm::dvec2 kWhiteD65{0.3127, 0.3290};
constexpr Primaries kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};

// ITU-T H.273, table 2. The white is D65 for all: cinema's P3 (SMPTE 431) differs there, and is read as if adapted.
Primaries primaries_of(AVColorPrimaries tag) {
  switch (tag) {
    case AVCOL_PRI_SMPTE170M:
    case AVCOL_PRI_SMPTE240M:
      return {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}};
    case AVCOL_PRI_BT470BG:
      return {{0.64, 0.33}, {0.29, 0.60}, {0.15, 0.06}};
    case AVCOL_PRI_BT2020:
      return {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}};
    case AVCOL_PRI_SMPTE431:
    case AVCOL_PRI_SMPTE432:
      return {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}};
    default:
      return kRec709;
  }
}

glm::dvec3 xyz_of(const glm::dvec2& chromaticity) {
  return {chromaticity.x / chromaticity.y, 1.0, (1.0 - chromaticity.x - chromaticity.y) / chromaticity.y};
}

// SMPTE RP 177: scale the primaries so that their sum is the white.
glm::dmat3 xyz_from_rgb(const Primaries& primaries) {
  const glm::dmat3 unscaled(xyz_of(primaries.red), xyz_of(primaries.green), xyz_of(primaries.blue));
  const glm::dvec3 scale = glm::inverse(unscaled) * xyz_of(kWhiteD65);
  return {unscaled[0] * scale.x, unscaled[1] * scale.y, unscaled[2] * scale.z};
}

TransferFunction transfer_of(AVColorTransferCharacteristic tag) {
  switch (tag) {
    case AVCOL_TRC_LINEAR:
      return TransferFunction::linear;
    case AVCOL_TRC_GAMMA22:
      return TransferFunction::gamma22;
    case AVCOL_TRC_GAMMA28:
      return TransferFunction::gamma28;
    case AVCOL_TRC_SMPTE2084:
      return TransferFunction::pq;
    case AVCOL_TRC_ARIB_STD_B67:
      return TransferFunction::hlg;
    default:
      return TransferFunction::srgb;
  }
}

// (Kr, Kg, Kb). The same choice as swscale's where nothing is said: BT.601.
glm::dvec3 luma_weights(AVColorSpace tag) {
  const auto from = [](double red, double blue) { return glm::dvec3(red, 1.0 - red - blue, blue); };
  switch (tag) {
    case AVCOL_SPC_BT709:
      return from(0.2126, 0.0722);
    case AVCOL_SPC_FCC:
      return from(0.30, 0.11);
    case AVCOL_SPC_SMPTE240M:
      return from(0.212, 0.087);
    case AVCOL_SPC_BT2020_NCL:
    case AVCOL_SPC_BT2020_CL:
      return from(0.2627, 0.0593);
    default:
      return from(0.299, 0.114);
  }
}

[[gnu::target_clones("avx2", "default")]] void write_codes(const glm::mat3& matrix, const glm::vec3& offset, const float* rgba,
                                                           int count, const std::array<float*, 3>& codes) {
  constexpr int kMaxAtOnce = 64;  // so that the compiler sees plain arrays
  std::array<float, kMaxAtOnce> red, green, blue;
  for (int first = 0; first < count; first += kMaxAtOnce) {
    const int pixels = std::min(kMaxAtOnce, count - first);
    for (int x = 0; x < pixels; ++x) {
      const float* pixel = rgba + 4 * (first + x);
      const auto at = static_cast<std::size_t>(x);
      red[at] = code_of(pixel[0]), green[at] = code_of(pixel[1]), blue[at] = code_of(pixel[2]);
    }
    for (int i = 0; i < 3; ++i) {
      float* to = codes[static_cast<std::size_t>(i)] + first;
      const float from_red = matrix[0][i], from_green = matrix[1][i], from_blue = matrix[2][i], zero = offset[i];
      for (int x = 0; x < pixels; ++x) {
        const auto at = static_cast<std::size_t>(x);
        to[x] = from_red * red[at] + from_green * green[at] + from_blue * blue[at] + zero;
      }
    }
  }
}

}  // namespace

PlateColor plate_color(const AVFrame& picture) {
  PlateColor color;
  color.transfer = transfer_of(picture.color_trc);
  const Primaries primaries = primaries_of(picture.color_primaries);
  // Exactly the identity for Rec. 709, not a product with its inverse.
  if (primaries.red != kRec709.red || primaries.green != kRec709.green) {
    color.plate_from_rec709 = glm::mat3(glm::inverse(xyz_from_rgb(primaries)) * xyz_from_rgb(kRec709));
  }
  return color;
}

bool is_full_range(const AVFrame& picture, const PixelLayout& layout) {
  if (layout.model == ColorModel::rgb) return true;
  if (layout.model == ColorModel::gray) return picture.color_range != AVCOL_RANGE_MPEG;
  return picture.color_range == AVCOL_RANGE_JPEG;
}

CodeFromRgb::CodeFromRgb(const AVFrame& picture, const PixelLayout& layout) : max_code_(layout.max_code()) {
  if (layout.model == ColorModel::rgb || layout.is_float) {
    matrix_ = glm::dmat3(max_code_);
    return;
  }
  const double step = 1 << (layout.depth() - 8);  // limited range's codes are the 8-bit ones, shifted
  const bool full = is_full_range(picture, layout);
  const double luma_span = full ? max_code_ : 219 * step;
  const double chroma_span = full ? max_code_ : 224 * step;
  const glm::dvec3 weights = luma_weights(picture.colorspace);
  const glm::dvec3 blue = (glm::dvec3(0, 0, 1) - weights) / (2.0 * (1.0 - weights.b));
  const glm::dvec3 red = (glm::dvec3(1, 0, 0) - weights) / (2.0 * (1.0 - weights.r));
  matrix_ = glm::transpose(glm::dmat3(weights * luma_span, blue * chroma_span, red * chroma_span));
  offset_ = {full ? 0 : 16 * step, 128 * step, 128 * step};
}

void CodeFromRgb::row(const float* rgba, int count, const std::array<float*, 3>& codes) const {
  write_codes(glm::mat3(matrix_), glm::vec3(offset_), rgba, count, codes);
}

}  // namespace catchlight::app
