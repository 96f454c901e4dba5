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

  /// Adds `strength` times the bloom to `target`, of the grid's size, over `texels`.
  void add(const GlTexture& excess, float strength, const ColorTarget<1>& scratch, const ColorTarget<1>& target,
           const PixelRect& texels, const GlareBlur& blur) const;

 private:
  struct Level {
    ColorTarget<1> shrunk, scratch, glow;
  };

  PixelRect texels_at(const PixelRect& texels, int level) const;

  GlProgram down_, up_;
  std::vector<BloomBlur> blurs_;
  std::vector<Level> levels_;  ///< the first has half of the grid's resolution
};

}  // namespace catchlight::render
