#include "render/cpu/plate_composite.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "catchlight/error.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/parallel.hpp"
#include "render/receiver_light.hpp"
#include "shaders/noise.h"

namespace catchlight::render {
namespace {

constexpr int kRowsAtOnce = 8;

/// The smallest difference of codes that counts: a quarter of a code of 8 bits, or of 12 where there may be more.
float changed_code(Plate::Format format) {
  return format == Plate::Format::rgb_u8 ? 0.25f / 255 : 0.25f / 4095;
}

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::vec3 finite_or_zero(const glm::vec3& v) {
  if (is_finite(v)) return v;
  return {std::isfinite(v.x) ? v.x : 0, std::isfinite(v.y) ? v.y : 0, std::isfinite(v.z) ? v.z : 0};
}

/// The noise that blocks of pixels share and that each has of its own, along a row.
class NoiseRow {
 public:
  NoiseRow(const SensorNoise& noise, int y) : noise_(noise), y_(y) {}

  glm::vec3 missing(int x, const glm::vec3& light, const glm::vec3& background, const glm::vec3& kept) {
    const glm::ivec2 block(x >> noise_.block_shift.x, y_ >> noise_.block_shift.y);
    if (block != block_) {
      block_ = block;
      shared_ = {shading::gaussian(block, noise_.frame, 0u), shading::gaussian(block, noise_.frame, 1u)};
    }
    const glm::vec3 unit = noise_.mix * glm::vec3(shared_, shading::gaussian({x, y_}, noise_.frame, 2u));
    return shading::missing_sigma(noise_.slope, noise_.floor, light, background, kept) * unit;
  }

 private:
  const SensorNoise& noise_;
  int y_;
  glm::ivec2 block_{-1};
  glm::vec2 shared_{0};
};

struct Pixel {
  glm::vec3 code;
  glm::vec4 object{0};  ///< premultiplied
  glm::vec3 ratio{1}, glare{0};

  bool is_untouched() const { return object.w == 0 && is_no_shadow(ratio) && glare == glm::vec3(0); }
};

class PlateComposite {
 public:
  PlateComposite(const FrameView& view, const Plate& plate, const ResponseTable& response, const VirtualImages& virtual_images,
                 bool as_light, Composite& result)
      : view_(view), plate_(plate), response_(response), virtual_(virtual_images), as_light_(as_light), result_(result) {
    clips_ = plate.format != Plate::Format::rgb_f32;
    changed_code_ = changed_code(plate.format);
    has_vignetting_ = view.camera.vignetting != glm::dvec3(0.0) && virtual_.passed_at_tag > 0;
  }

  void row(int y, std::vector<float>& glare) {
    const PixelRect& rect = result_.rect;
    if (virtual_.glare) {
      glare.resize(3 * static_cast<std::size_t>(rect.width));
      virtual_.glare(rect.x, y, rect.width, glare.data());
    }
    NoiseRow noise(view_.effects.noise, y);
    float* out = &result_.rgba[4 * static_cast<std::size_t>(y - rect.y) * rect.width];
    for (int i = 0; i < rect.width; ++i, out += 4) {
      const int x = rect.x + i;
      const std::size_t in_plate = static_cast<std::size_t>(y - plate_.rect.y) * plate_.rect.width + (x - plate_.rect.x);
      Pixel pixel = pixel_at(x, y, in_plate);
      if (virtual_.glare) pixel.glare = {glare[3 * i], glare[3 * i + 1], glare[3 * i + 2]};
      put(x, y, in_plate, pixel, noise, out);
    }
  }

 private:
  Pixel pixel_at(int x, int y, std::size_t in_plate) const {
    Pixel pixel{ResponseTable::codes(plate_, in_plate)};
    const int u = x - virtual_.rect.x, v = y - virtual_.rect.y;
    if (u < 0 || v < 0 || u >= virtual_.rect.width || v >= virtual_.rect.height) return pixel;
    if (virtual_.object) {
      const float* object = virtual_.object->pixel(u, v);
      pixel.object = {object[0], object[1], object[2], object[3]};
      if (has_vignetting_ && pixel.object.w > 0) {
        const auto passed = static_cast<float>(vignetting_at(view_.camera, {x, y}) / virtual_.passed_at_tag);
        pixel.object = glm::vec4(glm::vec3(pixel.object) * passed, pixel.object.w);
      }
    }
    if (virtual_.shadow) {
      const float* ratio = virtual_.shadow->pixel(u, v);
      pixel.ratio = {ratio[0], ratio[1], ratio[2]};
    }
    return pixel;
  }

  void put(int x, int y, std::size_t in_plate, Pixel& pixel, NoiseRow& noise, float* out) {
    const bool untouched = pixel.is_untouched();
    if (untouched && !as_light_ && !result_.layers) {
      out[0] = pixel.code.x, out[1] = pixel.code.y, out[2] = pixel.code.z, out[3] = 0;
      return;
    }
    // Black is light the lens scatters: no shadow takes it away, and the object stands behind it too.
    const glm::vec3 background = finite_or_zero(response_.linear(plate_, in_plate));
    glm::vec3 lit = background;
    // Where the plate is clipped the receiver is brighter than it shows, and so is its shadow.
    for (int c = 0; clips_ && c < 3; ++c)
      if (pixel.code[c] >= static_cast<float>(kClippingCode)) lit[c] = std::max(lit[c], view_.receiver_light[c]);
    const float kept = 1 - pixel.object.w;
    const glm::vec3 shadowed = glm::max(lit - view_.black, 0.0f) * pixel.ratio + glm::min(background, view_.black);
    const glm::vec3 over = glm::vec3(pixel.object) + pixel.object.w * view_.black;
    glm::vec3 light = shadowed * kept + over + pixel.glare;
    if (view_.effects.noise.enabled && !untouched) light += noise.missing(x, light, background, kept * pixel.ratio);
    if (as_light_)
      out[0] = light.x, out[1] = light.y, out[2] = light.z, out[3] = 1;
    else
      put_code(pixel.code, light, untouched, out);
    if (result_.layers) put_layers(x, y, background, shadowed, {over, pixel.object.w}, pixel.glare);
  }

  void put_code(const glm::vec3& code, const glm::vec3& light, bool untouched, float* out) const {
    bool changed = false;
    for (int c = 0; c < 3; ++c) {
      out[c] = untouched ? code[c] : response_.code(light[c], c);
      if (clips_) out[c] = std::clamp(out[c], 0.0f, 1.0f);
      // A NaN in the plate compares as changed once something virtual covers it.
      changed = changed || !(std::abs(out[c] - code[c]) <= changed_code_);
    }
    out[3] = changed && !untouched ? 1 : 0;
  }

  void put_layers(int x, int y, const glm::vec3& background, const glm::vec3& shadowed, const glm::vec4& over,
                  const glm::vec3& glare) {
    Layers& layers = *result_.layers;
    for (int c = 0; c < 3; ++c) {
      layers.plate.pixel(x, y)[c] = background[c];
      layers.shadow.pixel(x, y)[c] = background[c] > 0 ? shadowed[c] / background[c] : 1;
      layers.glare.pixel(x, y)[c] = glare[c];
    }
    for (int c = 0; c < 4; ++c) layers.object.pixel(x, y)[c] = over[c];
  }

  const FrameView& view_;
  const Plate& plate_;
  const ResponseTable& response_;
  const VirtualImages& virtual_;
  bool as_light_, clips_, has_vignetting_;
  float changed_code_;
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
  PlateComposite composite(view, plate, response, virtual_images, as_light, result);
  parallel_for(static_cast<std::size_t>((rect.height + kRowsAtOnce - 1) / kRowsAtOnce), 0, [&](std::size_t band) {
    std::vector<float> glare;
    const int first = rect.y + static_cast<int>(band) * kRowsAtOnce;
    for (int y = first; y < std::min(first + kRowsAtOnce, rect.y + rect.height); ++y) composite.row(y, glare);
  });
}

}  // namespace catchlight::render
