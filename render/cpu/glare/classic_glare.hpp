// The glare of the classic look (render/passes/glare/classic_glare.hpp has its origin), of everything bright in the picture.
#pragma once

#include <array>
#include <vector>

#include "catchlight/image.hpp"
#include "render/cpu/glare/glare_filters.hpp"
#include "render/cpu/glare/glare_picture.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

class ClassicGlare {
 public:
  explicit ClassicGlare(const GlareSettings& settings);

  /// Makes the glare of a picture (RGBA, linear): of luminance over settings.threshold, which keeps its colour.
  void draw(const Image& light);

  /// Adds it, by its strengths, to row y of the picture. May be called from several threads at once.
  void add_to_row(int y, Float4* row) const;

  /// As ClassicLook has them: the bright parts and the bloom 512 squared, the streaks 128 squared.
  const GlarePicture& bright() const { return bright_[0].picture; }
  const GlarePicture& bloom() const { return bloom_; }
  const GlarePicture& streaks() const { return streaks_; }

 private:
  /// The bright parts at a size, and blurred.
  struct Size {
    GlarePicture picture, half_blurred, blurred;
    std::vector<LinearSamples> at_512;  ///< where the texels of the largest lie on it
  };

  void resize(int width, int height);
  void find_bright(const Image& light);
  void make_bloom();
  void make_streaks();

  GlareSettings settings_;
  int width_ = 0, height_ = 0;
  std::array<Size, 4> bright_;  ///< 512, 256, 128 and 64 squared
  GlarePicture bloom_, streaks_, pixel_line_, texel_line_;
  std::array<GlarePicture, 2> between_;  ///< what one pass of a streak leaves to the next
  std::vector<LinearSamples> columns_of_bloom_, rows_of_bloom_, columns_of_streaks_, rows_of_streaks_;
};

}  // namespace catchlight::render
