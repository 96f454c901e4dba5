#include "render/passes/glare/classic_glare.hpp"

#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "render/gl/shader.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
namespace {

constexpr int kStreakPasses = 3;
constexpr std::array<glm::ivec2, 4> kDiagonals{{{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};

/// Nothing comes in from beyond the picture.
ColorTarget<1> square_target(const char* label, int size) {
  ColorTarget<1> target(label, GL_RGBA32F, size, size, GL_LINEAR);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  return target;
}

/// To be laid over the whole picture, up to its edge.
ColorTarget<1> result_target(const char* label, int size) {
  return ColorTarget<1>(label, GL_RGBA32F, size, size, GL_LINEAR);
}

GlProgram program(const char* fragment, const std::string& folder) {
  return make_program({.vertex = "fullscreen.vert", .fragment = fragment, .captured = {}}, folder);
}

}  // namespace

double classic_attenuation(double attenuation_at_480_rows) {
  return std::pow(attenuation_at_480_rows, 480.0 / 128);
}

ClassicLook::ClassicLook(const std::string& shader_folder)
    : bright_program_(program("classic_bright.frag", shader_folder)),
      shrink_(program("classic_shrink.frag", shader_folder)),
      blur_(program("classic_blur.frag", shader_folder)),
      sum_(program("classic_sum.frag", shader_folder)),
      streak_(program("classic_streak.frag", shader_folder)),
      no_attributes_(make_vertex_array("no attributes")),
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

void ClassicLook::draw_over(const ColorTarget<1>& target, const GlTexture& source) const {
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  glViewport(0, 0, target.width(), target.height());
  glBindTextureUnit(TEXTURE_SOURCE, source.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void ClassicLook::draw(const GlTexture& light, int width, int height, double threshold, double attenuation) {
  reset_state();
  glBindVertexArray(no_attributes_.id());
  glUseProgram(bright_program_.id());
  glProgramUniform2i(bright_program_.id(), 0, width, height);
  glProgramUniform1f(bright_program_.id(), 1, static_cast<float>(threshold));
  draw_over(bright_, light);

  glUseProgram(shrink_.id());
  draw_over(bright_256_, bright_.texture());
  draw_over(bright_128_, bright_256_.texture());
  draw_over(bright_64_, bright_128_.texture());

  glUseProgram(blur_.id());
  blur(bright_, half_done_512_, blurred_512_);
  blur(bright_256_, half_done_256_, blurred_256_);
  blur(bright_64_, half_done_64_, blurred_64_);
  glUseProgram(sum_.id());
  glBindTextureUnit(TEXTURE_BLOOM, blurred_256_.texture().id());
  glBindTextureUnit(TEXTURE_STREAKS, blurred_64_.texture().id());
  draw_over(bloom_, blurred_512_.texture());

  draw_streaks(bright_128_.texture(), attenuation);
}

void ClassicLook::blur(const ColorTarget<1>& source, const ColorTarget<1>& half_done, const ColorTarget<1>& target) const {
  glProgramUniform2i(blur_.id(), 0, 1, 0);
  draw_over(half_done, source.texture());
  glProgramUniform2i(blur_.id(), 0, 0, 1);
  draw_over(target, half_done.texture());
}

void ClassicLook::draw_streaks(const GlTexture& source, double attenuation) const {
  const float zero[4] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(streaks_.framebuffer(), GL_COLOR, 0, zero);
  glUseProgram(streak_.id());
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  for (const glm::ivec2& diagonal : kDiagonals) {
    const GlTexture* from = &source;
    for (int pass = 0; pass < kStreakPasses; ++pass) {
      const bool is_last = pass + 1 == kStreakPasses;
      const int b = 1 << (2 * pass);
      const float scale = is_last ? 1.0f / kDiagonals.size() : 1.0f;
      glProgramUniform2i(streak_.id(), 0, diagonal.x * b, diagonal.y * b);
      glProgramUniform2f(streak_.id(), 1, static_cast<float>(std::pow(attenuation, b)), scale);
      const ColorTarget<1>& target = is_last ? streaks_ : streak_pass_[pass];
      if (is_last) glEnable(GL_BLEND);
      draw_over(target, *from);
      glDisable(GL_BLEND);
      from = &target.texture();
    }
  }
}

}  // namespace catchlight::render
