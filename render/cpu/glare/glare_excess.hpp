// What of an object's light the sensor cannot hold, on the glare grid: what shaders/glare_tiles.frag, glare_filter.frag and
// glare_bright.frag draw.
#pragma once

#include <vector>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/cpu/glare/glare_picture.hpp"
#include "render/glare/glare_plan.hpp"
#include "render/glare/tile_mask.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

class GlareExcess {
 public:
  explicit GlareExcess(const GlareSettings& settings) : settings_(settings) {}

  /// Makes what a grid needs.
  void resize(const GlareGrid& grid);

  /// Finds the excess of `object` (RGBA, exposed linear, the frame's pixels of `rect`). `emission`: the object's own light among
  /// it, in the same pixels; null where it glares as the rest. False where nothing is over the threshold.
  bool find(const Image& object, const Image* emission, const PixelRect& rect);

  /// Texels around all of the excess.
  const PixelRect& light() const { return light_rect_; }
  const GlarePicture& all() const { return all_; }

  /// Whether the excess is also there in two parts, for streaks of their own.
  bool is_divided() const { return is_divided_; }
  const GlarePicture& reflected() const { return reflected_; }
  const GlarePicture& emitted() const { return emitted_; }

 private:
  /// The pixels under each texel along an axis, and how much of each the texel gets.
  struct AxisFilter {
    int taps;
    std::vector<int> first;  ///< pixel of the frame, for each texel
    std::vector<float> weights;

    AxisFilter(int texels, double texel_px);
    const float* weights_of(int texel) const { return &weights[static_cast<std::size_t>(texel * taps)]; }
  };
  struct Pixels {
    const Image& object;
    const Image* emission;
    const PixelRect& rect;
  };

  bool find_tiles(const Pixels& pixels);
  void filter_row(const Pixels& pixels, int y, const Span& texels);
  Span sum_rows(const Pixels& pixels, int y, const Span& texels);
  void look_along_row(int y, const Span& texels);
  void gate_row(int y, const Span& texels);
  bool divide_row(int y, const Span& texels);
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * grid_.columns + x); }

  GlareSettings settings_;
  GlareGrid grid_{};
  AxisFilter across_{0, 1}, down_{0, 1};
  TileMask tiles_;
  PixelRect light_rect_;
  bool is_divided_ = false;
  std::vector<Float4> pixel_line_;  ///< a row of texels, still by pixels
  GlarePicture light_, all_, reflected_, emitted_;
  /// Brightest channel of each texel; highest and mean of them along the row within the gate's reach.
  std::vector<float> peaks_, highest_, means_, gate_;
};

}  // namespace catchlight::render
