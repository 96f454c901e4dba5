#include "render/cpu/plate_composite.hpp"

#include <algorithm>
#include <array>
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

/// Pixels of a row that are worked on together: arrays, so that the compiler works on several at once.
struct Run {
  static constexpr int kMost = 256;
  using Values = std::array<float, kMost>;

  int x = 0, y = 0, count = 0;
  std::array<Values, 3> code, background, object, ratio, glare, light;
  Values coverage;
};

/// Unit noise that blocks of pixels share.
void shared_noise(const SensorNoise& noise, const Run& run, std::uint32_t stream, Run::Values& result) {
  const int across = noise.block_shift.x, row = run.y >> noise.block_shift.y;
  for (int i = 0; i < run.count;) {
    const int block = (run.x + i) >> across;
    const float value = shading::gaussian({block, row}, noise.frame, stream);
    for (; i < run.count && (run.x + i) >> across == block; ++i) result[i] = value;
  }
}

[[gnu::target_clones("avx2", "default")]] void own_noise(int x, int y, std::uint32_t seed, int count, float* result) {
  for (int i = 0; i < count; ++i) result[i] = shading::gaussian({x + i, y}, seed, 2u);
}

/// Adds the noise that what is virtual lacks.
void add_noise(const SensorNoise& noise, Run& run) {
  Run::Values first, second, own;
  shared_noise(noise, run, 0u, first);
  shared_noise(noise, run, 1u, second);
  own_noise(run.x, run.y, noise.frame, run.count, own.data());
  for (int c = 0; c < 3; ++c) {
    const float slope = noise.slope[c], lowest = noise.floor[c];
    const float of_first = noise.mix[0][c], of_second = noise.mix[1][c], of_own = noise.mix[2][c];
    Run::Values &light = run.light[c], &background = run.background[c], &ratio = run.ratio[c];
    for (int i = 0; i < run.count; ++i) {
      const float kept = (1 - run.coverage[i]) * ratio[i];
      const float sigma = shading::missing_sigma(slope, lowest, light[i], background[i], kept);
      light[i] += sigma * (of_first * first[i] + of_second * second[i] + of_own * own[i]);
    }
  }
}

class PlateComposite {
 public:
  PlateComposite(const FrameView& view, const Plate& plate, const ResponseTable& response, const VirtualImages& virtual_images,
                 bool as_light, Composite& result)
      : view_(view), plate_(plate), response_(response), virtual_(virtual_images), as_light_(as_light), result_(result) {
    clips_ = plate.format != Plate::Format::rgb_f32;
    changed_code_ = changed_code(plate.format);
    has_vignetting_ = view.camera.vignetting != glm::dvec3(0.0) && virtual_.passed_at_tag > 0;
  }

  void row(int y, std::vector<float>& glare) const {
    const PixelRect& rect = result_.rect;
    if (virtual_.glare) {
      glare.resize(3 * static_cast<std::size_t>(rect.width));
      virtual_.glare(rect.x, y, rect.width, glare.data());
    }
    thread_local Run run;
    run.y = y;
    for (int i = 0; i < rect.width; i += Run::kMost) {
      run.x = rect.x + i;
      run.count = std::min(Run::kMost, rect.width - i);
      float* out = &result_.rgba[4 * (static_cast<std::size_t>(y - rect.y) * rect.width + i)];
      put(run, virtual_.glare ? &glare[3 * static_cast<std::size_t>(i)] : nullptr, out);
    }
  }

 private:
  std::size_t in_plate(int x, int y) const {
    return static_cast<std::size_t>(y - plate_.rect.y) * plate_.rect.width + (x - plate_.rect.x);
  }

  /// Object, shadow and glare of the run. Whether anything is virtual in it.
  bool read_virtual(Run& run, const float* glare) const {
    const int v = run.y - virtual_.rect.y;
    bool any = false;
    for (int i = 0; i < run.count; ++i) {
      const int u = run.x + i - virtual_.rect.x;
      const bool inside = u >= 0 && v >= 0 && u < virtual_.rect.width && v < virtual_.rect.height;
      static constexpr float kNoObject[4] = {0, 0, 0, 0}, kNoShadow[4] = {1, 1, 1, 1};
      const float* object = inside && virtual_.object ? virtual_.object->pixel(u, v) : kNoObject;
      const float* ratio = inside && virtual_.shadow ? virtual_.shadow->pixel(u, v) : kNoShadow;
      const bool no_shadow = is_no_shadow({ratio[0], ratio[1], ratio[2]});
      run.coverage[i] = object[3];
      any = any || object[3] > 0 || !no_shadow;
      for (int c = 0; c < 3; ++c) {
        run.object[c][i] = object[c];
        run.ratio[c][i] = no_shadow ? 1 : ratio[c];
        run.glare[c][i] = glare ? glare[3 * i + c] : 0;
        any = any || run.glare[c][i] != 0;
      }
    }
    return any;
  }

  bool is_untouched(const Run& run, int i) const {
    return run.coverage[i] == 0 && run.ratio[0][i] == 1 && run.ratio[1][i] == 1 && run.ratio[2][i] == 1 && run.glare[0][i] == 0 &&
           run.glare[1][i] == 0 && run.glare[2][i] == 0;
  }

  void put(Run& run, const float* glare, float* out) const {
    const bool any = read_virtual(run, glare);
    const std::size_t first = in_plate(run.x, run.y);
    if (!any && !as_light_ && !result_.layers) {
      response_.read_codes(plate_, first, run.count, Run::kMost, run.code[0].data());
      for (int i = 0; i < run.count; ++i, out += 4)
        out[0] = run.code[0][i], out[1] = run.code[1][i], out[2] = run.code[2][i], out[3] = 0;
      return;
    }
    response_.read(plate_, first, run.count, Run::kMost, run.code[0].data(), run.background[0].data());
    if (plate_.format == Plate::Format::rgb_f32) make_finite(run);
    if (has_vignetting_) darken(run);
    put_light(run);
    if (view_.effects.noise.enabled && any) add_noise(view_.effects.noise, run);
    for (int i = 0; i < run.count; ++i) put_code(run, i, out + 4 * i);
    if (result_.layers)
      for (int i = 0; i < run.count; ++i) put_layers(run, i);
  }

  static void make_finite(Run& run) {
    for (auto& channel : run.background)
      for (int i = 0; i < run.count; ++i)
        if (!std::isfinite(channel[i])) channel[i] = 0;
  }

  void darken(Run& run) const {
    for (int i = 0; i < run.count; ++i) {
      if (run.coverage[i] == 0) continue;
      const auto passed = static_cast<float>(vignetting_at(view_.camera, {run.x + i, run.y}) / virtual_.passed_at_tag);
      for (int c = 0; c < 3; ++c) run.object[c][i] *= passed;
    }
  }

  /// Light of the receiver as the object shadows it, with what the plate clipped.
  float shadowed(float code, float background, float ratio, int c) const {
    const float black = view_.black[c];
    // Where the plate is clipped the receiver is brighter than it shows, and so is its shadow.
    const bool is_clipped = clips_ && code >= static_cast<float>(kClippingCode);
    const float lit = is_clipped ? std::max(background, view_.receiver_light[c]) : background;
    // Black is light the lens scatters: no shadow takes it away, and the object stands behind it too.
    return std::max(lit - black, 0.0f) * ratio + std::min(background, black);
  }

  void put_light(Run& run) const {
    for (int c = 0; c < 3; ++c) {
      const float black = view_.black[c];
      for (int i = 0; i < run.count; ++i)
        run.light[c][i] = shadowed(run.code[c][i], run.background[c][i], run.ratio[c][i], c) * (1 - run.coverage[i]) +
                          (run.object[c][i] + run.coverage[i] * black) + run.glare[c][i];
    }
  }

  void put_code(const Run& run, int i, float* out) const {
    if (as_light_) {
      out[0] = run.light[0][i], out[1] = run.light[1][i], out[2] = run.light[2][i], out[3] = 1;
      return;
    }
    const bool untouched = is_untouched(run, i);
    bool changed = false;
    for (int c = 0; c < 3; ++c) {
      const float code = run.code[c][i];
      out[c] = untouched ? code : response_.code(run.light[c][i], c);
      if (clips_) out[c] = std::clamp(out[c], 0.0f, 1.0f);
      // A NaN in the plate compares as changed once something virtual covers it.
      changed = changed || !(std::abs(out[c] - code) <= changed_code_);
    }
    out[3] = changed && !untouched ? 1 : 0;
  }

  void put_layers(const Run& run, int i) const {
    Layers& layers = *result_.layers;
    const int x = run.x + i, y = run.y;
    for (int c = 0; c < 3; ++c) {
      const float background = run.background[c][i];
      layers.plate.pixel(x, y)[c] = background;
      layers.shadow.pixel(x, y)[c] = background > 0 ? shadowed(run.code[c][i], background, run.ratio[c][i], c) / background : 1;
      layers.glare.pixel(x, y)[c] = run.glare[c][i];
      layers.object.pixel(x, y)[c] = run.object[c][i] + run.coverage[i] * view_.black[c];
    }
    layers.object.pixel(x, y)[3] = run.coverage[i];
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
  const PlateComposite composite(view, plate, response, virtual_images, as_light, result);
  parallel_for(static_cast<std::size_t>((rect.height + kRowsAtOnce - 1) / kRowsAtOnce), 0, [&](std::size_t band) {
    std::vector<float> glare;
    const int first = rect.y + static_cast<int>(band) * kRowsAtOnce;
    for (int y = first; y < std::min(first + kRowsAtOnce, rect.y + rect.height); ++y) composite.row(y, glare);
  });
}

}  // namespace catchlight::render
