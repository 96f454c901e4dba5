#include "render/cpu/glare/glare_spreader.hpp"

#include <algorithm>
#include <cmath>

#include "render/cpu/glare/glare_filters.hpp"

namespace catchlight::render {
namespace {

/// Black texels on both sides of a line, so that what lies around its lit ones can be read.
constexpr int kPad = 4;
/// The filter that halves the resolution.
constexpr std::array kDown{0.125f, 0.375f, 0.375f, 0.125f};
/// A quarter of a texel before the third of four: read bilinearly, and as a cubic B-spline.
constexpr std::array kBilinear{0.0f, 0.25f, 0.75f, 0.0f};
constexpr std::array kCubic{1.0f / 384, 121.0f / 384, 235.0f / 384, 27.0f / 384};

/// The sum over all texels, in the channel that has most.
double total(const GlarePicture& picture) {
  glm::dvec3 sum(0);
  for (int y = 0; y < picture.rows(); ++y) {
    const Span lit = picture.lit(y);
    for (int x = lit.begin; x < lit.end; ++x)
      for (int c = 0; c < 3; ++c) sum[c] += picture.row(y)[x][c];
  }
  return std::max({sum.r, sum.g, sum.b});
}

}  // namespace

void GlareSpreader::resize(const GlareGrid& grid, int frame_height) {
  grid_ = grid;
  frame_height_ = frame_height;
  blurs_ = plan_bloom(grid.rows_per_height(frame_height));
  levels_.clear();
  for (int level = 0; level <= std::max(blurs_.back().level, 1); ++level) {
    const GlareGrid size = grid.halved(level);
    const GlarePicture picture(size.columns, size.rows);
    levels_.push_back({level == 0 ? GlarePicture() : picture, picture, picture, GlarePicture(size.columns + 2 * kPad, 1)});
  }
}

const GlarePicture& GlareSpreader::source(const GlareExcess& excess, int level) const {
  return level == 0 ? excess.all() : levels_[static_cast<std::size_t>(level)].shrunk;
}

PixelRect GlareSpreader::spread(const GlareExcess& excess) {
  for (int level = 1; level <= coarsest(); ++level) shrink(source(excess, level - 1), level);
  const GlareSpread plan = plan_spread(settings_, grid_, frame_height_, excess.light(), total(excess.all()), excess.is_divided());
  for (int level = coarsest(); level >= 0; --level) {
    const PixelRect reached = level == 0 ? plan.texels : texels_at(plan.texels, grid_, level);
    glow(excess, level, reached);
    if (level != plan.streaks.level || settings_.streak_strength <= 0) continue;
    add_star(excess.is_divided() ? excess.reflected() : source(excess, level), settings_.streak_directions, plan, reached);
    if (excess.is_divided()) add_star(excess.emitted(), settings_.emitter_directions, plan, reached);
  }
  return plan.texels;
}

/// Sums four rows of a level's picture into its line, black around; texel x of the result is column x of the picture.
const Float4* GlareSpreader::start_line(int level, const GlarePicture& picture, int first_row,
                                        const std::array<float, 4>& weights) {
  GlarePicture& line = levels_[static_cast<std::size_t>(level)].line;
  line.clear();
  for (int k = 0; k < 4; ++k) {
    const float weight = weights[static_cast<std::size_t>(k)];
    if (weight != 0) line.add(0, picture, first_row + k, kPad, splat(weight), line.all_columns());
  }
  if (const Span lit = line.lit(0); !lit.empty()) line.widen(0, {lit.begin - kPad, lit.end + kPad});
  return line.row(0) + kPad;
}

/// Halves the resolution (shaders/glare_down.frag): texel i is made of 2 i - 5 ... 2 i - 2.
void GlareSpreader::shrink(const GlarePicture& from, int level) {
  GlarePicture& to = levels_[static_cast<std::size_t>(level)].shrunk;
  to.clear();
  for (int y = 0; y < to.rows(); ++y) {
    const Float4* line = start_line(level - 1, from, 2 * y - 5, kDown);
    const Span lit = levels_[static_cast<std::size_t>(level) - 1].line.lit(0);
    if (lit.empty()) continue;
    // The line's black texels and its padding count in `lit`.
    const Span texels = intersect({(lit.begin + 3) / 2, (lit.end - 2 * kPad + 4) / 2 + 1}, to.all_columns());
    Float4* row = to.widen(y, texels);
    for (int x = texels.begin; x < texels.end; ++x) {
      const Float4* four = line + 2 * x - 5;
      row[x] = kDown[0] * (four[0] + four[3]) + kDown[1] * (four[1] + four[2]);
    }
  }
}

/// Makes a level's glow: the bloom of this level and of the coarser ones.
void GlareSpreader::glow(const GlareExcess& excess, int level, const PixelRect& reached) {
  GlarePicture& to = levels_[static_cast<std::size_t>(level)].glow;
  to.clear();
  if (level < coarsest()) add_coarser(level, reached);
  if (settings_.bloom_strength <= 0) return;
  for (const BloomBlur& each : blurs_)
    if (each.level == level)
      add_blurred(source(excess, level), each.taps, settings_.bloom_strength * each.weight,
                  levels_[static_cast<std::size_t>(level)].scratch, to, reached);
}

/// Adds the coarser level's glow (shaders/glare_up.frag): texel 2 j is made of the four from j, texel 2 j + 1 of those from j + 1
/// with the weights in reverse.
void GlareSpreader::add_coarser(int level, const PixelRect& reached) {
  const Level& coarser = levels_[static_cast<std::size_t>(level) + 1];
  GlarePicture& to = levels_[static_cast<std::size_t>(level)].glow;
  const std::array<float, 4>& weights = level == 0 ? kCubic : kBilinear;
  const auto [a, b, c, d] = weights;
  const std::array<float, 4> reversed{d, c, b, a};
  for (int y = reached.y; y < reached.y + reached.height; ++y) {
    const Float4* line = start_line(level + 1, coarser.glow, (y + 1) / 2, y % 2 == 0 ? weights : reversed);
    const Span lit = coarser.line.lit(0);
    if (lit.empty()) continue;
    const Span texels = intersect({2 * lit.begin - 7, 2 * (lit.end - 2 * kPad) - 1}, columns_of(reached));
    if (texels.empty()) continue;
    Float4* row = to.widen(y, texels);
    for (int x = texels.begin; x < texels.end; ++x) {
      const Float4* four = line + (x + 1) / 2;
      row[x] += x % 2 == 0 ? a * four[0] + b * four[1] + c * four[2] + d * four[3]
                           : d * four[0] + c * four[1] + b * four[2] + a * four[3];
    }
  }
}

/// Adds streaks in several directions to the glow of the level that they are drawn on.
void GlareSpreader::add_star(const GlarePicture& from, int directions, const GlareSpread& plan, const PixelRect& reached) {
  const int level = plan.streaks.level;
  GlarePicture& to = levels_[static_cast<std::size_t>(level)].glow;
  const PixelRect all = grid_.halved(level).all();
  const std::vector<double> taps = gaussian_taps(plan.streaks.own_blur);
  if (taps.size() > 1) {
    fit(narrow_, to);
    add_blurred(from, taps, 1, levels_[static_cast<std::size_t>(level)].scratch, narrow_, all);
  }
  const GlarePicture& narrow = taps.size() > 1 ? narrow_ : from;
  const double texel = std::exp2(level);
  const Star star =
      plan_star(settings_, directions, grid_.rows_per_height(frame_height_) / texel, plan.streak_reach_texels / texel);
  for (const std::vector<StreakSamples>& passes : star.arms) {
    const GlarePicture* source = &narrow;
    for (std::size_t p = 0; p + 1 < passes.size(); ++p) {
      fit(between_[p % 2], to);
      add_streak_pass(*source, passes[p], between_[p % 2], all);
      source = &between_[p % 2];
    }
    add_streak_pass(*source, passes.back(), to, reached);
  }
  for (int y = reached.y; y < reached.y + reached.height; ++y)
    to.add(y, narrow, y, 0, float4(star.at_source), columns_of(reached));
}

}  // namespace catchlight::render
