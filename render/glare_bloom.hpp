// Bloom: the excess blurred by several Gaussians, each at the resolution that it needs.
#pragma once

#include <string>
#include <vector>

#include "render/glare_blur.hpp"
#include "render/glare_plan.hpp"

namespace catchlight::render {

class BloomPass {
 public:
  explicit BloomPass(const std::string& shader_folder);

  /// For a grid of that many texels, margins included.
  void resize(int columns, int rows, double rows_per_height);

  /// Halves the excess again and again; needed before the two below.
  void shrink(const GlTexture& excess, const PixelRect& texels);

  struct Brightness {
    double total;      ///< sum over the texels of the grid, of the channel that has most
    PixelRect texels;  ///< of the grid, around all that are not black
  };
  Brightness brightness() const;

  /// The halvings by number, from 1: the excess, and what glows of it there.
  struct Level {
    ColorTarget<1> shrunk, scratch, glow;
  };
  const Level& level(int number) const { return levels_[static_cast<std::size_t>(number) - 1]; }
  /// Texels of a level that touch these of the grid, and as many around them as the way up reads.
  PixelRect texels_at(const PixelRect& texels, int level) const;

  /// Makes `strength` times the bloom, at its levels and, for what needs the grid itself, in `target`.
  void blur(const GlTexture& excess, float strength, const ColorTarget<1>& scratch, const ColorTarget<1>& target,
            const PixelRect& texels, const GlareBlur& blur) const;

  /// Adds what glows at all levels to `target`, of the grid's size, over `texels`.
  void gather(const ColorTarget<1>& target, const PixelRect& texels) const;

 private:
  GlProgram down_, up_;
  std::vector<BloomBlur> blurs_;
  std::vector<Level> levels_;  ///< the first has half of the grid's resolution
};

}  // namespace catchlight::render
