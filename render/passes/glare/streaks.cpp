#include "render/passes/glare/streaks.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/interface.h"

namespace catchlight::render {
namespace {

/// Most rows that the bands between passes have together.
constexpr int kMaxRows = 4096;

/// The texels in which a pass leaves light that lay within `light`.
PixelRect swept(const PixelRect& light, const StreakSamples& samples, const ColorTarget<1>& target) {
  constexpr int kAround = 2;  // what interpolation reads
  const PixelRect near{light.x - kAround, light.y - kAround, light.width + 2 * kAround, light.height + 2 * kAround};
  const glm::dvec2 furthest = (samples.count - 1.0) * samples.pace;
  const int x = static_cast<int>(std::lround(furthest.x)), y = static_cast<int>(std::lround(furthest.y));
  const PixelRect all = unite(near, {near.x + x, near.y + y, near.width, near.height});
  return intersect(all, {0, 0, target.width(), target.height()});
}

PixelRect lowered(PixelRect rect, int texels) {
  rect.y += texels;
  return rect;
}

}  // namespace

const Program& StreakPass::pass(const GlTexture& source, const StreakSamples& samples, int down, const PixelRect& bounds) {
  const glm::vec2 pace(samples.pace);
  const bool along_x = std::abs(pace.x) >= std::abs(pace.y);
  std::vector<std::string> defines;
  if (pace != glm::floor(pace)) defines = {"SLANTED"};
  Program& program = shaders_.program(fullscreen_with_taps("glare_streak.frag", samples.count, defines));
  program.set("offset", glm::vec2(0, down));
  program.set("pace", pace);
  program.set("across", along_x ? glm::ivec2(0, 1) : glm::ivec2(1, 0));
  program.set("gain", glm::vec3(samples.gain));
  program.set("falloff", glm::vec3(samples.falloff));
  program.set("bounds", glm::ivec4(bounds.x, bounds.y, bounds.x + bounds.width - 1, bounds.y + bounds.height - 1));
  glBindTextureUnit(TEXTURE_SOURCE, source.id());
  return program;
}

void StreakPass::add(const GlTexture& source, const PixelRect& light, std::span<const std::vector<StreakSamples>> arms,
                     const ColorTarget<1>& target, const PixelRect& texels) {
  const std::size_t at_once = static_cast<std::size_t>(std::max(1, kMaxRows / target.height()));
  for (; !arms.empty(); arms = arms.subspan(std::min(at_once, arms.size())))
    add_some(source, light, arms.first(std::min(at_once, arms.size())), target, texels);
}

void StreakPass::add_some(const GlTexture& source, const PixelRect& light, std::span<const std::vector<StreakSamples>> arms,
                          const ColorTarget<1>& target, const PixelRect& texels) {
  const int height = target.height(), rows = height * static_cast<int>(arms.size());
  if (between_.empty() || between_[0].width() != target.width() || between_[0].height() < rows) {
    between_.clear();
    for (int i = 0; i < 2; ++i) between_.push_back(make_glare_target("streaks", target.width(), rows));
  }
  std::vector<PixelRect> lit(arms.size(), light);
  const std::size_t last = arms[0].size() - 1;
  for (std::size_t p = 0; p <= last; ++p) {
    const GlTexture& from = p == 0 ? source : between_[(p - 1) % 2].texture();
    for (std::size_t a = 0; a < arms.size(); ++a) {
      const int band = height * static_cast<int>(a), from_band = p == 0 ? 0 : band, to_band = p == last ? 0 : band;
      const Program& program = pass(from, arms[a][p], from_band - to_band, lowered(lit[a], from_band));
      lit[a] = swept(lit[a], arms[a][p], target);
      if (p < last)
        draw_.over(lowered(lit[a], to_band), between_[p % 2].framebuffer(), program);
      else
        draw_.over(intersect(lit[a], texels), target.framebuffer(), program, Blending::add);
    }
  }
}

}  // namespace catchlight::render
