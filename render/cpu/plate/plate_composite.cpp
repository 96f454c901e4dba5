#include "render/cpu/plate/plate_composite.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "catchlight/error.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/parallel.hpp"
#include "render/math/float4.hpp"
#include "render/receiver_light.hpp"
#include "shaders/noise.h"

namespace catchlight::render {
namespace {

constexpr int kRowsAtOnce = 8;
/// Light that moves no code of 8 bits by a quarter, however dark the plate is.
constexpr float kInvisibleGlare = 5e-5f;

/// The smallest difference of codes that counts: a quarter of a code of 8 bits, or of 12 where there may be more.
float changed_code(Plate::Format format) {
  return format == Plate::Format::rgb_u8 ? 0.25f / 255 : 0.25f / 4095;
}

[[gnu::target_clones("avx2", "default")]] void fill_noise(glm::ivec2 place, std::uint32_t seed, std::uint32_t stream, int count,
                                                          float* result) {
  for (int i = 0; i < count; ++i) result[i] = shading::gaussian({place.x + i, place.y}, seed, stream);
}

Float4 square_root(Float4 v) {
  Float4 root;
  for (int i = 0; i < 4; ++i) root[i] = std::sqrt(v[i]);
  return root;
}

/// The noise of a row of pixels, of variance 1: two numbers that blocks share, and one of each pixel's own.
class NoiseRow {
 public:
  NoiseRow(const SensorNoise& noise, int x, int y, int count) : noise_(noise), first_block_(x >> noise.block_shift.x), x_(x) {
    const int blocks = ((x + count - 1) >> noise.block_shift.x) - first_block_ + 1;
    for (int stream = 0; stream < 2; ++stream) {
      shared_[stream].resize(static_cast<std::size_t>(blocks));
      fill_noise({first_block_, y >> noise.block_shift.y}, noise.frame, static_cast<std::uint32_t>(stream), blocks,
                 shared_[stream].data());
    }
    own_.resize(static_cast<std::size_t>(count));
    fill_noise({x, y}, noise.frame, 2u, count, own_.data());
    for (int i = 0; i < 3; ++i) mix_[i] = float4(noise.mix[i]);
    slope_ = float4(noise.slope), floor_ = float4(noise.floor);
  }

  /// What pixel i lacks, as shading::missing_sigma() says.
  Float4 missing(int i, Float4 light, Float4 background, Float4 kept) const {
    const auto block = static_cast<std::size_t>(((x_ + i) >> noise_.block_shift.x) - first_block_);
    const Float4 unit = mix_[0] * splat(shared_[0][block]) + mix_[1] * splat(shared_[1][block]) +
                        mix_[2] * splat(own_[static_cast<std::size_t>(i)]);
    const Float4 wanted = positive(slope_ * positive(light) + floor_);
    const Float4 there = kept * kept * positive(slope_ * positive(background) + floor_);
    return square_root(positive(wanted - there)) * unit;
  }

 private:
  const SensorNoise& noise_;
  int first_block_, x_;
  std::array<std::vector<float>, 2> shared_;
  std::vector<float> own_;
  std::array<Float4, 3> mix_;
  Float4 slope_, floor_;
};

bool is_below(Float4 light, float most) {
  return light[0] < most && light[1] < most && light[2] < most;
}

struct Pixel {
  Float4 code{}, background{};
  Float4 object{};  ///< premultiplied, coverage
  Float4 ratio{}, glare{};
  bool is_touched = false;
};

class PlateComposite {
 public:
  PlateComposite(const FrameView& view, const Plate& plate, const ResponseTable& response, const VirtualImages& virtual_images,
                 bool as_light, Composite& result)
      : view_(view), plate_(plate), response_(response), virtual_(virtual_images), as_light_(as_light), result_(result) {
    clips_ = plate.format != Plate::Format::rgb_f32;
    changed_code_ = changed_code(plate.format);
    has_vignetting_ = view.camera.vignetting != glm::dvec3(0.0) && virtual_.passed_at_tag > 0;
    black_ = float4(view.black), receiver_light_ = float4(view.receiver_light);
  }

  void row(int y) const {
    const PixelRect& rect = result_.rect;
    thread_local std::vector<float> glare;
    if (virtual_.glare) {
      glare.resize(3 * static_cast<std::size_t>(rect.width));
      virtual_.glare(rect.x, y, rect.width, glare.data());
    }
    std::optional<NoiseRow> noise;
    float* out = &result_.rgba[4 * static_cast<std::size_t>(y - rect.y) * rect.width];
    const std::size_t first = static_cast<std::size_t>(y - plate_.rect.y) * plate_.rect.width + (rect.x - plate_.rect.x);
    for (int i = 0; i < rect.width; ++i, out += 4) {
      const std::size_t in_plate = first + static_cast<std::size_t>(i);
      Pixel pixel = virtual_at(rect.x + i, y, virtual_.glare ? &glare[3 * static_cast<std::size_t>(i)] : nullptr);
      pixel.code = response_.codes(plate_, in_plate);
      if (!pixel.is_touched && !as_light_ && !result_.layers) {
        store(pixel.code, out);
        continue;
      }
      pixel.background = response_.linear(plate_, in_plate);
      if (view_.effects.noise.enabled && !noise && lacks_noise(pixel)) noise.emplace(view_.effects.noise, rect.x, y, rect.width);
      put(rect.x + i, y, pixel, noise ? &*noise : nullptr, out);
    }
  }

 private:
  Pixel virtual_at(int x, int y, const float* glare) const {
    Pixel pixel;
    pixel.ratio = splat(1);
    if (glare) pixel.glare = Float4{glare[0], glare[1], glare[2], 0};
    const int u = x - virtual_.rect.x, v = y - virtual_.rect.y;
    if (u >= 0 && v >= 0 && u < virtual_.rect.width && v < virtual_.rect.height) {
      if (virtual_.object) pixel.object = load(virtual_.object->pixel(u, v));
      if (virtual_.shadow) pixel.ratio = load(virtual_.shadow->pixel(u, v));
    }
    if (is_below(pixel.glare, kInvisibleGlare)) pixel.glare = Float4{};
    const bool no_shadow = is_no_shadow(rgb(pixel.ratio));
    if (no_shadow) pixel.ratio = splat(1);
    pixel.is_touched = pixel.object[3] > 0 || !no_shadow || pixel.glare[0] != 0 || pixel.glare[1] != 0 || pixel.glare[2] != 0;
    if (has_vignetting_ && pixel.object[3] > 0) {
      const auto passed = static_cast<float>(vignetting_at(view_.camera, {x, y}) / virtual_.passed_at_tag);
      pixel.object *= Float4{passed, passed, passed, 1};
    }
    return pixel;
  }

  /// A shadow or a glare of less than a 30th of the light leaves 96 % of the noise's variance: nobody sees what is missing.
  static bool lacks_noise(const Pixel& pixel) {
    constexpr float kFaint = 1.0f / 30;
    const Float4 change = pixel.ratio - splat(1), most = splat(kFaint);
    const auto is_faint = (change < most) & (-change < most) & (pixel.glare <= most * pixel.background);
    return pixel.object[3] > 0 || (is_faint[0] & is_faint[1] & is_faint[2]) == 0;
  }

  void put(int x, int y, const Pixel& pixel, const NoiseRow* noise, float* out) const {
    // Where the plate is clipped the receiver is brighter than it shows, and so is its shadow.
    Float4 lit = pixel.background;
    if (clips_) lit = pixel.code >= splat(static_cast<float>(kClippingCode)) && lit < receiver_light_ ? receiver_light_ : lit;
    // Black is light the lens scatters: no shadow takes it away, and the object stands behind it too.
    const Float4 shadowed = positive(lit - black_) * pixel.ratio + at_most(pixel.background, black_);
    const Float4 kept = splat(1 - pixel.object[3]), over = pixel.object + splat(pixel.object[3]) * black_;
    Float4 light = shadowed * kept + over + pixel.glare;
    if (noise && lacks_noise(pixel)) light += noise->missing(x - result_.rect.x, light, pixel.background, kept * pixel.ratio);
    if (as_light_) {
      light[3] = 1;
      store(light, out);
    } else {
      put_code(pixel, light, out);
    }
    if (result_.layers) put_layers(x, y, pixel, shadowed, over);
  }

  void put_code(const Pixel& pixel, Float4 light, float* out) const {
    if (!pixel.is_touched) return store(pixel.code, out);
    Float4 code{response_.code(light[0], 0), response_.code(light[1], 1), response_.code(light[2], 2), 0};
    if (clips_) code = at_most(positive(code), splat(1));
    // A NaN in the plate compares as changed once something virtual covers it.
    const Float4 change = code - pixel.code;
    const auto alike = (change <= splat(changed_code_)) & (change >= splat(-changed_code_));
    code[3] = (alike[0] & alike[1] & alike[2]) != 0 ? 0 : 1;
    store(code, out);
  }

  void put_layers(int x, int y, const Pixel& pixel, Float4 shadowed, Float4 over) const {
    Layers& layers = *result_.layers;
    for (int c = 0; c < 3; ++c) {
      layers.plate.pixel(x, y)[c] = pixel.background[c];
      layers.shadow.pixel(x, y)[c] = pixel.background[c] > 0 ? shadowed[c] / pixel.background[c] : 1;
      layers.glare.pixel(x, y)[c] = pixel.glare[c];
      layers.object.pixel(x, y)[c] = over[c];
    }
    layers.object.pixel(x, y)[3] = pixel.object[3];
  }

  const FrameView& view_;
  const Plate& plate_;
  const ResponseTable& response_;
  const VirtualImages& virtual_;
  bool as_light_, clips_, has_vignetting_;
  float changed_code_;
  Float4 black_, receiver_light_;
  Composite& result_;
};

}  // namespace

void check_plate(const Plate& plate) {
  const std::size_t channel_bytes = plate.format == Plate::Format::rgb_u8 ? 1 : plate.format == Plate::Format::rgb_u16 ? 2 : 4;
  const std::size_t expected =
      static_cast<std::size_t>(plate.rect.width) * static_cast<std::size_t>(plate.rect.height) * 3 * channel_bytes;
  if (plate.pixels.size() != expected) {
    throw Error("the plate's rectangle of " + std::to_string(plate.rect.width) + " x " + std::to_string(plate.rect.height) +
                " pixels needs " + std::to_string(expected) + " bytes, got " + std::to_string(plate.pixels.size()));
  }
}

void composite_plate(const FrameView& view, const Plate& plate, const ResponseTable& response,
                     const VirtualImages& virtual_images, bool as_light, Composite& result) {
  check_plate(plate);
  const PixelRect& rect = result.rect;
  result.rgba.resize(4 * static_cast<std::size_t>(rect.width) * rect.height);
  const PlateComposite composite(view, plate, response, virtual_images, as_light, result);
  parallel_for(static_cast<std::size_t>((rect.height + kRowsAtOnce - 1) / kRowsAtOnce), 0, [&](std::size_t band) {
    const int first = rect.y + static_cast<int>(band) * kRowsAtOnce;
    for (int y = first; y < std::min(first + kRowsAtOnce, rect.y + rect.height); ++y) composite.row(y);
  });
}

}  // namespace catchlight::render
