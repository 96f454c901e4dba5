// What exceeds the sensor's white spills in the lens: bloom and streaks, computed on a grid of few rows that is fixed to the
// frame (not to the object), so that it neither crawls nor changes with the frame's resolution.
#pragma once

#include <memory>
#include <string>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/shader_library.hpp"
#include "render/glare/glare_plan.hpp"
#include "render/passes/glare/bloom.hpp"
#include "render/passes/glare/glare_tiles.hpp"
#include "render/passes/glare/streaks.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

class GlarePass {
 public:
  GlarePass(const GlareSettings& settings, ShaderLibrary& shaders);

  /// Extracts what is over the threshold of `object` (which holds the frame's pixels of `rect`). `emission`: the object's own
  /// light among it, in the same pixels; null where it glares as the rest. False where nothing is: the frame has no glare.
  bool extract(const GlTexture& object, const GlTexture* emission, const PixelRect& rect, int frame_width, int frame_height);

  /// Draws bloom and streaks; only after extract() was true. Gives the pixels of the frame that they reach.
  PixelRect spread();

  /// The excess on the grid with its margins, exposed linear light per texel; read_excess() has it on the CPU, RGB.
  const GlTexture& excess() const { return excess_->texture(); }
  Image read_excess() const;
  const GlareGrid& grid() const { return grid_; }

  /// The glare that is added to the frame, exposed linear light on the same grid; to be read as a cubic B-spline.
  const GlTexture& glare() const { return glow_->texture(); }
  Image read_glare() const;
  /// Coordinates of the glare's texels: pixel of the frame times xy plus zw.
  glm::vec4 texels_from_frame() const;

 private:
  void make_targets(int frame_width, int frame_height);
  void filter(const GlTexture& object, const GlTexture* emission, const PixelRect& rect);
  /// A filter along one axis, ready to be drawn: pixel `first_pixel` of the frame is the first of `source_size` along it.
  const Program& axis_filter(std::vector<std::string> defines, int first_pixel, int source_size);
  void attach_parts();
  void add_narrow_bloom();
  void add_streaks(const GlareSpread& plan);
  void add_star(const GlTexture& source, int directions, const GlareSpread& plan);

  GlareSettings settings_;
  ShaderLibrary& shaders_;
  Program& bright_;
  FullscreenDraw draw_;
  GlareTiles tiles_;
  GlareBlur blur_;
  BloomPass bloom_;
  StreakPass streaks_;
  GlQuery any_bright_;
  GlareGrid grid_{};
  int frame_width_ = 0, frame_height_ = 0;
  bool divided_ = false;  ///< what is emitted has streaks of its own
  std::unique_ptr<ColorTarget<1>> filtered_rows_, reflected_, emitted_, light_, excess_, scratch_, narrow_, glow_;
};

}  // namespace catchlight::render
