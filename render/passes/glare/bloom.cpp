#include "render/passes/glare/bloom.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/image.hpp"
#include "render/gl/read_back.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
namespace {

constexpr std::size_t kReadLevel = 3;

}  // namespace

BloomPass::BloomPass(ShaderLibrary& shaders)
    : down_(shaders.program(fullscreen("glare_down.frag"))),
      up_(shaders.program(fullscreen("glare_up.frag", {"OWN"}))),
      up_to_grid_(shaders.program(fullscreen("glare_up.frag"))) {}

void BloomPass::resize(const GlareGrid& grid, double rows_per_height) {
  grid_ = grid;
  blurs_ = plan_bloom(rows_per_height);
  levels_.clear();
  for (int number = 1; number <= std::max(blurs_.back().level, 1); ++number) {
    const GlareGrid size = grid.halved(number);
    const auto target = [&](const char* label) { return make_glare_target(label, size.columns, size.rows); };
    levels_.push_back({target("shrunk excess"), target("bloom rows"), target("bloom")});
  }
}

void BloomPass::shrink(const GlTexture& excess, const PixelRect& texels) {
  const GlTexture* source = &excess;
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    clear(levels_[k].shrunk);
    glBindTextureUnit(TEXTURE_SOURCE, source->id());
    draw_.over(texels_at(texels, grid_, static_cast<int>(k) + 1), levels_[k].shrunk.framebuffer(), down_);
    source = &levels_[k].shrunk.texture();
  }
}

double BloomPass::total() const {
  // Small enough to be read back.
  const std::size_t level = std::min<std::size_t>(kReadLevel, levels_.size());
  const ColorTarget<1>& shrunk = levels_[level - 1].shrunk;
  const Image image = read_back(shrunk.framebuffer(), 0, shrunk.width(), shrunk.height(), 3);
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < image.data.size(); i += 3) sum += glm::dvec3(image.data[i], image.data[i + 1], image.data[i + 2]);
  return std::exp2(2 * level) * std::max({sum.r, sum.g, sum.b});
}

void BloomPass::glow(int number, double strength, const PixelRect& texels, GlareBlur& blur) {
  const Level& to = level(number);
  const PixelRect reached = texels_at(texels, grid_, number);
  double own_gain = 0;
  for (const BloomBlur& step : blurs_) {
    if (step.level == number && step.taps.size() == 1) own_gain += strength * step.weight;
  }
  up_.set("own_gain", static_cast<float>(own_gain));
  up_.set("coarser_gain", number == coarsest() ? 0.0f : 1.0f);
  glBindTextureUnit(TEXTURE_SOURCE, to.shrunk.texture().id());
  glBindTextureUnit(TEXTURE_COARSER, (number == coarsest() ? to.shrunk : level(number + 1).glow).texture().id());
  draw_.over(reached, to.glow.framebuffer(), up_);
  for (const BloomBlur& step : blurs_) {
    if (step.level == number && step.taps.size() > 1 && strength > 0)
      blur.add(to.shrunk.texture(), to.scratch, to.glow, step.taps, strength * step.weight, reached);
  }
}

void BloomPass::gather(const ColorTarget<1>& target, const PixelRect& texels) const {
  glBindTextureUnit(TEXTURE_COARSER, level(1).glow.texture().id());
  draw_.over(texels, target.framebuffer(), up_to_grid_);
}

}  // namespace catchlight::render
