// What exceeds the sensor's white spills in the lens: bloom and streaks, computed on a grid of half the frame's resolution that
// is fixed to the frame (not to the object), so that it does not crawl.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/compositor.hpp"
#include "render/render_target.hpp"

namespace catchlight::render {

/// How the settings, stated for 480 rows, translate to a frame of another size.
struct GlarePlan {
  int bloom_levels;           ///< halvings; the coarsest spreads over 2^levels px
  int streak_level;           ///< the halving that streaks are drawn at, 0 = half resolution
  int streak_passes;          ///< 4^passes samples reach until a^k is invisible
  double streak_attenuation;  ///< per texel of that level
  int reach_px;               ///< how far beyond a highlight anything changes
};

GlarePlan plan_glare(const GlareSettings& settings, int frame_height);

class GlarePass {
 public:
  GlarePass(const GlareSettings& settings, const std::string& shader_folder);

  /// Extracts what is over the threshold of `object` (which holds the frame's pixels of `rect`). False, and nothing else to do,
  /// where nothing is.
  bool extract(const GlTexture& object, const PixelRect& rect, int frame_width, int frame_height);

  /// After extract() was true: bloom and streaks around `rect`. Gives the pixels of the frame they reach.
  PixelRect spread(const PixelRect& rect);

  /// Both of unit energy: the sum over the frame equals the excess's.
  const GlTexture& bloom() const { return levels_.front().texture(); }
  const GlTexture& streaks() const { return streaks_->texture(); }
  /// Texture coordinates of bloom (xy) and streaks (zw) per pixel of the frame.
  glm::vec4 texture_from_frame() const;

 private:
  void make_targets(int frame_width, int frame_height);
  void draw(const ColorTarget<1>& target, const GlTexture& source, int level, const PixelRect& reach) const;
  void draw_bloom(const PixelRect& reach) const;
  void draw_streaks(const PixelRect& reach) const;
  void draw_streak(const glm::dvec2& direction, const PixelRect& reach) const;

  GlareSettings settings_;
  GlProgram bright_, down_, up_, streak_;
  GlVertexArray no_attributes_;
  GlQuery any_bright_;
  GlarePlan plan_{};
  int frame_width_ = 0, frame_height_ = 0;
  std::vector<ColorTarget<1>> levels_;  ///< level k has 1 / 2^(k+1) of the frame's resolution
  std::unique_ptr<ColorTarget<1>> streaks_, streak_passes_[2];
};

}  // namespace catchlight::render
