// Bloom: the excess blurred by several Gaussians, each at the resolution that it needs.
#pragma once

#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/glare/glare_plan.hpp"
#include "render/passes/glare/glare_blur.hpp"

namespace catchlight::render {

class BloomPass {
 public:
  explicit BloomPass(ShaderLibrary& shaders);

  /// Makes what a grid needs.
  void resize(const GlareGrid& grid, double rows_per_height);

  /// Halves the excess again and again; needed before the two below.
  void shrink(const GlTexture& excess, const PixelRect& texels);

  /// The excess summed over the grid, in the channel that has most.
  double total() const;

  /// A halving of the grid, by number from 1: the excess, and what glows of it there.
  struct Level {
    ColorTarget<1> shrunk, scratch, glow;
  };
  int coarsest() const { return static_cast<int>(levels_.size()); }
  const Level& level(int number) const { return levels_[static_cast<std::size_t>(number) - 1]; }

  /// The Gaussians to be drawn; those that need the grid itself are not drawn by this class.
  const std::vector<BloomBlur>& blurs() const { return blurs_; }

  /// Makes a level's glow, strength times the bloom of this level and the coarser ones; called from the coarsest level to the
  /// first. What else is to glow there is added before the next one is made.
  void glow(int number, double strength, const PixelRect& texels, GlareBlur& blur);

  /// Writes the first level's glow to `target`, of the grid's size, over `texels`.
  void gather(const ColorTarget<1>& target, const PixelRect& texels) const;

 private:
  Program &down_, &up_, &up_to_grid_;
  FullscreenDraw draw_;
  GlareGrid grid_{};
  std::vector<BloomBlur> blurs_;
  std::vector<Level> levels_;  ///< the first has half of the grid's resolution
};

}  // namespace catchlight::render
