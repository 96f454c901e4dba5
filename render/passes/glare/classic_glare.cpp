#include "render/passes/glare/classic_glare.hpp"

#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "shaders/interface.h"

namespace catchlight::render {
namespace {

constexpr int kStreakPasses = 3;
constexpr std::array<glm::ivec2, 4> kDiagonals{{{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};

/// A target into which nothing comes from beyond the picture.
ColorTarget<1> square_target(const char* label, int size) {
  ColorTarget<1> target(label, GL_RGBA32F, size, size, GL_LINEAR);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  return target;
}

/// A target that is laid over the whole picture, up to its edge.
ColorTarget<1> result_target(const char* label, int size) {
  return ColorTarget<1>(label, GL_RGBA32F, size, size, GL_LINEAR);
}

}  // namespace

ClassicLook::ClassicLook(ShaderLibrary& shaders)
    : bright_program_(shaders.program(fullscreen("classic_bright.frag"))),
      shrink_(shaders.program(fullscreen("classic_shrink.frag"))),
      blur_(shaders.program(fullscreen("classic_blur.frag"))),
      sum_(shaders.program(fullscreen("classic_sum.frag"))),
      streak_(shaders.program(fullscreen("classic_streak.frag"))),
      bright_(square_target("bright 512", 512)),
      bright_256_(square_target("bright 256", 256)),
      bright_128_(square_target("bright 128", 128)),
      bright_64_(square_target("bright 64", 64)),
      half_done_512_(square_target("half blurred 512", 512)),
      half_done_256_(square_target("half blurred 256", 256)),
      half_done_64_(square_target("half blurred 64", 64)),
      blurred_512_(result_target("blurred 512", 512)),
      blurred_256_(result_target("blurred 256", 256)),
      blurred_64_(result_target("blurred 64", 64)),
      bloom_(result_target("classic bloom", 512)),
      streak_pass_{square_target("streak", 128), square_target("streak", 128)},
      streaks_(result_target("classic streaks", 128)) {}

void ClassicLook::draw_over(const ColorTarget<1>& target, const GlTexture& source, const Program& program,
                            Blending blending) const {
  glBindTextureUnit(TEXTURE_SOURCE, source.id());
  draw_.over({0, 0, target.width(), target.height()}, target.framebuffer(), program, blending);
}

void ClassicLook::draw(const GlTexture& light, int width, int height, double threshold, double attenuation) {
  bright_program_.set("size", glm::ivec2(width, height));
  bright_program_.set("threshold", static_cast<float>(threshold));
  draw_over(bright_, light, bright_program_);

  draw_over(bright_256_, bright_.texture(), shrink_);
  draw_over(bright_128_, bright_256_.texture(), shrink_);
  draw_over(bright_64_, bright_128_.texture(), shrink_);

  blur(bright_, half_done_512_, blurred_512_);
  blur(bright_256_, half_done_256_, blurred_256_);
  blur(bright_64_, half_done_64_, blurred_64_);
  glBindTextureUnit(TEXTURE_BLOOM, blurred_256_.texture().id());
  glBindTextureUnit(TEXTURE_STREAKS, blurred_64_.texture().id());
  draw_over(bloom_, blurred_512_.texture(), sum_);

  draw_streaks(bright_128_.texture(), attenuation);
}

void ClassicLook::blur(const ColorTarget<1>& source, const ColorTarget<1>& half_done, const ColorTarget<1>& target) {
  blur_.set("axis", glm::ivec2(1, 0));
  draw_over(half_done, source.texture(), blur_);
  blur_.set("axis", glm::ivec2(0, 1));
  draw_over(target, half_done.texture(), blur_);
}

void ClassicLook::draw_streaks(const GlTexture& source, double attenuation) {
  const float zero[4] = {0, 0, 0, 0};
  reset_state();
  glClearNamedFramebufferfv(streaks_.framebuffer(), GL_COLOR, 0, zero);
  for (const glm::ivec2& diagonal : kDiagonals) {
    const GlTexture* from = &source;
    for (int pass = 0; pass < kStreakPasses; ++pass) {
      const bool is_last = pass + 1 == kStreakPasses;
      const int b = 1 << (2 * pass);
      const float scale = is_last ? 1.0f / kDiagonals.size() : 1.0f;
      streak_.set("step_texels", diagonal * b);
      streak_.set("weight", glm::vec2(std::pow(attenuation, b), scale));
      const ColorTarget<1>& target = is_last ? streaks_ : streak_pass_[pass];
      draw_over(target, *from, streak_, is_last ? Blending::add : Blending::replace);
      from = &target.texture();
    }
  }
}

}  // namespace catchlight::render
