#include "render/glare_streaks.hpp"

#include "shaders/interface.h"

namespace catchlight::render {

StreakPass::StreakPass(const std::string& shader_folder) : programs_("glare_streak.frag", shader_folder) {}

void StreakPass::resize(int columns, int rows) {
  between_.clear();
  for (int i = 0; i < 2; ++i) between_.push_back(make_glare_target("streak", columns, rows));
}

void StreakPass::begin() const {
  for (const auto& target : between_) clear(target);
}

void StreakPass::add(const GlTexture& source, const std::vector<StreakPassTaps>& passes, const ColorTarget<1>& target,
                     const PixelRect& texels) const {
  const GlTexture* from = &source;
  for (std::size_t p = 0; p < passes.size(); ++p) {
    glm::ivec2 offsets[kMaxStreakTaps];
    glm::vec3 weights[kMaxStreakTaps];
    const auto count = static_cast<GLsizei>(passes[p].size());
    for (std::size_t t = 0; t < passes[p].size(); ++t) offsets[t] = passes[p][t].offset, weights[t] = passes[p][t].weight;
    const GLuint program = programs_.with(count);
    glUseProgram(program);
    glProgramUniform2iv(program, 0, count, &offsets[0].x);
    glProgramUniform3fv(program, MAX_STREAK_TAPS, count, &weights[0].x);
    glBindTextureUnit(TEXTURE_SOURCE, from->id());
    if (p + 1 == passes.size()) {
      const AdditiveBlending blending;
      draw_over(target, texels);
    } else {
      draw_over(between_[p % 2], texels);
      from = &between_[p % 2].texture();
    }
  }
}

}  // namespace catchlight::render
