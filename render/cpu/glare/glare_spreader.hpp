// Bloom and streaks of an excess, on the glare grid and a pyramid of its halvings: what render/passes/glare draws.
#pragma once

#include <array>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/cpu/glare/glare_excess.hpp"
#include "render/cpu/glare/glare_picture.hpp"
#include "render/glare/glare_plan.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

class GlareSpreader {
 public:
  explicit GlareSpreader(const GlareSettings& settings) : settings_(settings) {}

  /// Makes what a grid needs.
  void resize(const GlareGrid& grid, int frame_height);

  /// Makes the glare; the texels that it reaches.
  PixelRect spread(const GlareExcess& excess);

  /// The glare that is added to the frame, exposed linear light; to be read as a cubic B-spline.
  const GlarePicture& glare() const { return levels_[0].glow; }

 private:
  /// The grid halved by its number; level 0 is the grid itself, whose source is the excess.
  struct Level {
    GlarePicture shrunk, glow, scratch;
    GlarePicture line;  ///< one row, with texels to spare on both sides
  };

  int coarsest() const { return static_cast<int>(levels_.size()) - 1; }
  const GlarePicture& source(const GlareExcess& excess, int level) const;
  const Float4* start_line(int level, const GlarePicture& picture, int first_row, const std::array<float, 4>& weights);
  void shrink(const GlarePicture& from, int level);
  void glow(const GlareExcess& excess, int level, const PixelRect& reached);
  void add_coarser(int level, const PixelRect& reached);
  void add_star(const GlarePicture& from, int directions, const GlareSpread& plan, const PixelRect& reached);

  GlareSettings settings_;
  GlareGrid grid_{};
  int frame_height_ = 0;
  std::vector<BloomBlur> blurs_;
  std::vector<Level> levels_;
  GlarePicture narrow_;                  ///< the streaks' source, blurred
  std::array<GlarePicture, 2> between_;  ///< what one pass of a streak leaves to the next
};

}  // namespace catchlight::render
