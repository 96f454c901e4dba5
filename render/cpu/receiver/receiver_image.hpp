// The receiver's shadow as the camera sees it.
#pragma once

#include <array>
#include <vector>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/cpu/receiver/receiver_shadow.hpp"
#include "render/cpu/surface/pixel_rays.hpp"
#include "render/frame_plan.hpp"

namespace catchlight::render {

/// The ratio of shadowed to unshadowed light in the pixels of a rectangle, and 1 around it. Where it changes evenly it is kept at
/// the corners of cells and interpolated, and no blur shows; pixels are kept around where it does not.
class ReceiverImage {
 public:
  /// Draws the shadow over the plan's rectangle.
  void draw(const FrameView& view, const FramePlan& plan, const PixelRays& pixel_rays, const ReceiverShadow& shadow);

  /// There is no shadow anywhere.
  void clear();

  /// The frame's pixels that `pixels` are.
  const PixelRect& rect() const { return rect_; }
  /// Bands of `pixels`, below each other, that hold where the shadow is sharp. Around them as much is drawn as the plan's blur
  /// reads; the rest of `pixels` holds nothing.
  const std::vector<PixelRect>& sharp() const { return sharp_; }
  /// Four channels, to be blurred.
  Image& pixels() { return pixels_; }

  /// The box around the frame's pixels that are in shadow.
  PixelRect shadowed() const;

  /// Writes the ratio of the frame's pixels (x, y) to (x + count - 1, y), a plane a channel. False where none is in shadow. May
  /// be called from several threads.
  bool read_row(int x, int y, int count, const std::array<float*, 3>& ratio) const;

 private:
  class Seen;
  struct Span {
    int begin = 0, end = 0;
    bool empty() const { return end == 0; }
    void add(const Span& other);
  };

  std::size_t corner(int column, int row) const { return static_cast<std::size_t>(row) * (columns_ + 1) + column; }
  PixelRect cell(int column, int row) const;
  bool is_bent(int column, int row) const;
  bool is_smooth(int column, int row) const;
  void find_shadowed();
  void find_sharp();
  std::vector<Span> around_sharp(int margin) const;
  void draw_cell(const Seen& seen, int column, int row);
  void interpolate(int x, int y, int count, const std::array<float*, 3>& ratio) const;

  PixelRect rect_;
  int columns_ = 0, rows_ = 0;                 ///< cells
  std::array<std::vector<float>, 3> corners_;  ///< a plane a channel
  std::vector<char> is_bent_;                  ///< a corner each
  // Columns of cells, a row of them each: in shadow, sharp, and blurred, which are read from `pixels`.
  std::vector<Span> shadowed_cells_, sharp_cells_, blurred_;
  std::vector<PixelRect> sharp_;
  Image pixels_;
};

}  // namespace catchlight::render
