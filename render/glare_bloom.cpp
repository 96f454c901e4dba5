#include "render/glare_bloom.hpp"

#include <algorithm>
#include <cmath>

#include "render/read_back.hpp"
#include "render/shader.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
namespace {

constexpr std::size_t kReadLevel = 3;

}  // namespace

BloomPass::BloomPass(const std::string& shader_folder)
    : down_(make_program({.vertex = "fullscreen.vert", .fragment = "glare_down.frag", .captured = {}}, shader_folder)),
      up_(make_program({.vertex = "fullscreen.vert", .fragment = "glare_up.frag", .captured = {}}, shader_folder)) {}

void BloomPass::resize(int columns, int rows, double rows_per_height) {
  blurs_ = plan_bloom(rows_per_height);
  levels_.clear();
  int width = columns - 2 * GLARE_MARGIN, height = rows - 2 * GLARE_MARGIN;
  for (int level = 1; level <= std::max(blurs_.back().level, 1); ++level) {
    width = (width + 1) / 2, height = (height + 1) / 2;
    const auto target = [&](const char* label) {
      return make_glare_target(label, width + 2 * GLARE_MARGIN, height + 2 * GLARE_MARGIN);
    };
    levels_.push_back({target("shrunk excess"), target("bloom rows"), target("bloom")});
  }
}

PixelRect BloomPass::texels_at(const PixelRect& texels, int level) const {
  constexpr int kAround = 3;
  const ColorTarget<1>& target = levels_[static_cast<std::size_t>(level) - 1].shrunk;
  const double step = std::exp2(level);
  const auto low = [&](int t) { return static_cast<int>(std::floor((t - GLARE_MARGIN) / step)) + GLARE_MARGIN - kAround; };
  const auto high = [&](int t) { return static_cast<int>(std::ceil((t - GLARE_MARGIN) / step)) + GLARE_MARGIN + kAround; };
  const int x = low(texels.x), y = low(texels.y);
  return intersect({x, y, high(texels.x + texels.width) - x, high(texels.y + texels.height) - y},
                   {0, 0, target.width(), target.height()});
}

void BloomPass::shrink(const GlTexture& excess, const PixelRect& texels) {
  glUseProgram(down_.id());
  const GlTexture* source = &excess;
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    clear(levels_[k].shrunk);
    glBindTextureUnit(TEXTURE_SOURCE, source->id());
    draw_over(levels_[k].shrunk, texels_at(texels, static_cast<int>(k) + 1));
    source = &levels_[k].shrunk.texture();
  }
}

BloomPass::Brightness BloomPass::brightness() const {
  // Small enough to be read back, and fine enough to tell where the light is.
  const std::size_t level = std::min<std::size_t>(kReadLevel, levels_.size());
  const int step = 1 << level;
  const ColorTarget<1>& shrunk = levels_[level - 1].shrunk;
  const Image image = read_back(shrunk.framebuffer(), 0, shrunk.width(), shrunk.height(), 3);
  glm::dvec3 sum(0);
  PixelRect texels;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* light = image.pixel(x, y);
      if (light[0] + light[1] + light[2] <= 0) continue;
      sum += glm::dvec3(light[0], light[1], light[2]);
      texels = unite(texels, {(x - GLARE_MARGIN) * step + GLARE_MARGIN, (y - GLARE_MARGIN) * step + GLARE_MARGIN, step, step});
    }
  }
  return {step * step * std::max({sum.r, sum.g, sum.b}), texels};
}

void BloomPass::blur(const GlTexture& excess, float strength, const ColorTarget<1>& scratch, const ColorTarget<1>& target,
                     const PixelRect& texels, const GlareBlur& blur) const {
  for (const Level& each : levels_) clear(each.glow);
  if (strength <= 0) return;
  for (const BloomBlur& step : blurs_) {
    std::vector<float> taps = step.taps;
    for (float& tap : taps) tap *= std::sqrt(strength);
    if (step.level == 0) {
      blur.add(excess, scratch, target, taps, texels);
    } else {
      const Level& at = level(step.level);
      blur.add(at.shrunk.texture(), at.scratch, at.glow, taps, texels_at(texels, step.level));
    }
  }
}

void BloomPass::gather(const ColorTarget<1>& target, const PixelRect& texels) const {
  glUseProgram(up_.id());
  const AdditiveBlending blending;
  for (std::size_t k = levels_.size(); k-- > 0;) {
    glBindTextureUnit(TEXTURE_COARSER, levels_[k].glow.texture().id());
    draw_over(k == 0 ? target : levels_[k - 1].glow, k == 0 ? texels : texels_at(texels, static_cast<int>(k)));
  }
}

}  // namespace catchlight::render
