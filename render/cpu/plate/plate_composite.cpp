#include "render/cpu/plate/plate_composite.hpp"

#include <algorithm>
#include <string>

#include "catchlight/error.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/parallel.hpp"
#include "render/cpu/plate/plate_block.hpp"
#include "render/math/float4.hpp"

namespace catchlight::render {
namespace {

/// A quarter of a code of 8 bits, or of 12 where there may be more.
float changed_code(Plate::Format format) {
  return format == Plate::Format::rgb_u8 ? 0.25f / 255 : 0.25f / 4095;
}

class PlateComposite {
 public:
  /// `is_band`: nobody will ask for codes that did not change.
  PlateComposite(const FrameView& view, const Plate& plate, const ResponseTable& response, const VirtualImages& virtual_images,
                 bool as_light, bool is_band, Composite& result)
      : view_(view),
        plate_(plate),
        response_(response),
        virtual_(virtual_images),
        levels_{view.black, view.receiver_light, plate.format != Plate::Format::rgb_f32, changed_code(plate.format)},
        as_light_(as_light),
        is_band_(is_band),
        result_(result) {
    has_vignetting_ = view.camera.vignetting != glm::dvec3(0.0) && virtual_.passed_at_tag > 0;
  }

  void row(int y) const {
    const int end = result_.rect.x + result_.rect.width;
    PlateBlock block;
    for (int x = result_.rect.x; x < end; x += kBlockPixels) {
      block.x = x, block.y = y, block.count = std::min(kBlockPixels, end - x);
      put(block);
    }
  }

 private:
  void put(PlateBlock& block) const {
    const std::size_t in_plate =
        static_cast<std::size_t>(block.y - plate_.rect.y) * plate_.rect.width + (block.x - plate_.rect.x);
    const bool wants_all = as_light_ || result_.layers;
    const bool is_touched = (read_virtual(block) || wants_all) && find_touched(block);
    if (!is_touched && is_band_) return leave(block);
    if (!is_touched && !wants_all) {
      response_.read(plate_, in_plate, block.count, block.code);
      write(block, block.code, nullptr);
      return;
    }
    response_.read(plate_, in_plate, block.count, block.code, block.background);
    composite_light(levels_, block);
    if (view_.effects.noise.enabled) add_missing_noise(view_.effects.noise, block);
    if (as_light_) {
      write(block, block.light, &block.is_touched);
    } else {
      for (int c = 0; c < 3; ++c) response_.code(block.light, c, block.count, block.result);
      find_changed(levels_, block);
      write(block, block.result, &block.is_changed);
    }
    if (result_.layers) put_layers(block);
  }

  /// False where there is nothing virtual.
  bool read_virtual(PlateBlock& block) const {
    const auto fill = [&](Planes& planes, float value) {
      for (Plane& plane : planes) std::fill_n(plane.data(), block.count, value);
    };
    bool is_there = false;
    if (virtual_.shadow)
      is_there |=
          virtual_.shadow(block.x, block.y, block.count, {block.ratio[0].data(), block.ratio[1].data(), block.ratio[2].data()});
    else
      fill(block.ratio, 1);
    fill(block.object, 0);
    std::fill_n(block.coverage.data(), block.count, 0.0f);
    if (virtual_.object) is_there |= read_object(block);
    if (!virtual_.glare) {
      fill(block.glare, 0);
      return is_there;
    }
    read_glare(block);
    return true;
  }

  void read_glare(PlateBlock& block) const {
    std::array<float, 3 * kBlockPixels> rgb;
    virtual_.glare(block.x, block.y, block.count, rgb.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); ++i)
      for (std::size_t c = 0; c < 3; ++c) block.glare[c][i] = rgb[3 * i + c];
  }

  bool read_object(PlateBlock& block) const {
    const PixelRect seen = intersect({block.x, block.y, block.count, 1}, virtual_.object_rect);
    if (seen.empty()) return false;
    for (int x = seen.x; x < seen.x + seen.width; ++x) {
      const float* pixel = virtual_.object->pixel(x - virtual_.object_rect.x, block.y - virtual_.object_rect.y);
      const auto i = static_cast<std::size_t>(x - block.x);
      block.coverage[i] = pixel[3];
      const float passed = has_vignetting_ && pixel[3] > 0 ? passed_at({x, block.y}) : 1;
      for (std::size_t c = 0; c < 3; ++c) block.object[c][i] = pixel[c] * passed;
      if (!result_.layers) continue;
      const float* mirrored = virtual_.reflection->pixel(x - virtual_.object_rect.x, block.y - virtual_.object_rect.y);
      for (std::size_t c = 0; c < 3; ++c) result_.layers->reflection.pixel(x, block.y)[c] = mirrored[c] * passed;
    }
    return true;
  }

  float passed_at(const glm::dvec2& pixel) const {
    return static_cast<float>(vignetting_at(view_.camera, pixel) / virtual_.passed_at_tag);
  }

  float* place(const PlateBlock& block) const {
    const PixelRect& rect = result_.rect;
    return &result_.rgba[4 * (static_cast<std::size_t>(block.y - rect.y) * rect.width + (block.x - rect.x))];
  }

  void leave(const PlateBlock& block) const { std::fill_n(place(block), 4 * block.count, 0.0f); }

  /// `changed`: null where nothing has. Of light all has.
  void write(const PlateBlock& block, const Planes& rgb, const PixelMask* changed) const {
    float* out = place(block);
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); ++i) {
      const bool is_changed = as_light_ || (changed && (*changed)[i] != 0);
      store(Float4{rgb[0][i], rgb[1][i], rgb[2][i], is_changed ? 1.0f : 0.0f}, out + 4 * i);
    }
  }

  void put_layers(const PlateBlock& block) const {
    Layers& layers = *result_.layers;
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); ++i) {
      const int x = block.x + static_cast<int>(i);
      for (std::size_t c = 0; c < 3; ++c) {
        const float background = block.background[c][i];
        layers.plate.pixel(x, block.y)[c] = background;
        layers.shadow.pixel(x, block.y)[c] = background > 0 ? block.shadowed[c][i] / background : 1;
        layers.glare.pixel(x, block.y)[c] = block.glare[c][i];
        layers.object.pixel(x, block.y)[c] = block.over[c][i];
      }
      layers.object.pixel(x, block.y)[3] = block.coverage[i];
    }
  }

  const FrameView& view_;
  const Plate& plate_;
  const ResponseTable& response_;
  const VirtualImages& virtual_;
  PlateLevels levels_;
  bool as_light_, is_band_, has_vignetting_;
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
                     const VirtualImages& virtual_images, bool as_light, const CompositeSink& take, Composite& result) {
  check_plate(plate);
  const PixelRect& rect = result.rect;
  const auto make_room = [](Composite& composite) {
    composite.rgba.resize(4 * static_cast<std::size_t>(composite.rect.width) * composite.rect.height);
  };
  const auto draw_rows = [&](const PixelRect& rows, Composite& to) {
    const PlateComposite composite(view, plate, response, virtual_images, as_light, static_cast<bool>(take), to);
    for (int y = rows.y; y < rows.y + rows.height; ++y) composite.row(y);
  };
  if (!take) make_room(result);
  const int top = rect.y / kCompositeBandRows, bottom = (rect.y + rect.height - 1) / kCompositeBandRows;
  parallel_for(static_cast<std::size_t>(bottom - top + 1), 0, [&](std::size_t band) {
    const int first = (top + static_cast<int>(band)) * kCompositeBandRows;
    const PixelRect rows = intersect({rect.x, first, rect.width, kCompositeBandRows}, rect);
    if (!take) return draw_rows(rows, result);
    thread_local Composite taken;
    taken.rect = rows;
    taken.plate = std::shared_ptr<const Plate>(std::shared_ptr<const Plate>(), &plate);  // no more than a pointer
    make_room(taken);
    draw_rows(rows, taken);
    take(taken);
  });
}

}  // namespace catchlight::render
