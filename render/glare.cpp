#include "render/glare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/shader.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
namespace {

constexpr double kReferenceRows = 480.0;
constexpr GLenum kGlareFormat = GL_RGBA16F;
/// Share of each coarser level in the one before it: a long tail with a narrow core.
constexpr float kBloomSpread = 0.65f;
/// A streak ends where this is left of it; times the brightest highlight that glares, 1e3, it is below a quarter code.
constexpr double kStreakEnd = 1e-5;

ColorTarget<1> make_level(const char* label, int frame_width, int frame_height, int level) {
  const int step = 2 << level;
  ColorTarget<1> target(label, kGlareFormat, (frame_width + step - 1) / step, (frame_height + step - 1) / step, GL_LINEAR);
  // Nothing comes in from beyond the frame.
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(target.texture().id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  return target;
}

void clear(const ColorTarget<1>& target) {
  const float zero[4] = {0, 0, 0, 0};
  glDisable(GL_SCISSOR_TEST);
  glClearNamedFramebufferfv(target.framebuffer(), GL_COLOR, 0, zero);
}

}  // namespace

GlarePlan plan_glare(const GlareSettings& settings, int frame_height) {
  const double octaves = std::log2(std::max(frame_height, 1) / kReferenceRows);
  GlarePlan plan{};
  plan.bloom_levels = std::clamp(5 + static_cast<int>(std::lround(octaves)), 2, 8);
  plan.streak_level = std::clamp(static_cast<int>(std::lround(octaves)), 0, plan.bloom_levels - 1);
  // a^k for k texels of that level, each 2^(level+1) px of this frame, whose pixels are 480 / height of the reference's.
  const double reference_px_per_texel = std::exp2(plan.streak_level + 1) * kReferenceRows / std::max(frame_height, 1);
  plan.streak_attenuation = std::pow(std::clamp(settings.streak_attenuation, 0.0, 0.999), reference_px_per_texel);
  const double visible_texels = plan.streak_attenuation > 0 ? std::log(kStreakEnd) / std::log(plan.streak_attenuation) : 1.0;
  plan.streak_passes = std::clamp(static_cast<int>(std::ceil(std::log2(visible_texels) / 2)), 1, 6);
  const double streak_px = std::min(visible_texels, std::exp2(2 * plan.streak_passes)) * std::exp2(plan.streak_level + 1);
  const double bloom_px = 4 * std::exp2(plan.bloom_levels);
  plan.reach_px = static_cast<int>(std::ceil(std::max(streak_px, bloom_px)));
  return plan;
}

GlarePass::GlarePass(const GlareSettings& settings, const std::string& shader_folder)
    : settings_(settings),
      bright_(make_program({.vertex = "fullscreen.vert", .fragment = "glare_bright.frag", .captured = {}}, shader_folder)),
      down_(make_program({.vertex = "fullscreen.vert", .fragment = "glare_down.frag", .captured = {}}, shader_folder)),
      up_(make_program({.vertex = "fullscreen.vert", .fragment = "glare_up.frag", .captured = {}}, shader_folder)),
      streak_(make_program({.vertex = "fullscreen.vert", .fragment = "glare_streak.frag", .captured = {}}, shader_folder)),
      no_attributes_(make_vertex_array("no attributes")),
      any_bright_(make_query(GL_ANY_SAMPLES_PASSED)) {}

void GlarePass::make_targets(int frame_width, int frame_height) {
  frame_width_ = frame_width;
  frame_height_ = frame_height;
  plan_ = plan_glare(settings_, frame_height);
  levels_.clear();
  for (int level = 0; level < plan_.bloom_levels; ++level)
    levels_.push_back(make_level("bloom", frame_width, frame_height, level));
  const auto streak_target = [&] {
    return std::make_unique<ColorTarget<1>>(make_level("streaks", frame_width, frame_height, plan_.streak_level));
  };
  streaks_ = streak_target();
  for (auto& target : streak_passes_) target = streak_target();
}

/// Draws the current program over the part of `target`, of resolution `level`, that `reach` (pixels of the frame) touches.
void GlarePass::draw(const ColorTarget<1>& target, const GlTexture& source, int level, const PixelRect& reach) const {
  const int step = 2 << level;
  const int x = reach.x / step, y = reach.y / step;
  const int right = (reach.x + reach.width + step - 1) / step, bottom = (reach.y + reach.height + step - 1) / step;
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  glViewport(0, 0, target.width(), target.height());
  glEnable(GL_SCISSOR_TEST);
  glScissor(x, y, right - x, bottom - y);
  glBindTextureUnit(TEXTURE_SOURCE, source.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

bool GlarePass::extract(const GlTexture& object, const PixelRect& rect, int frame_width, int frame_height) {
  if (levels_.empty() || frame_width != frame_width_ || frame_height != frame_height_) make_targets(frame_width, frame_height);
  reset_state();
  glBindVertexArray(no_attributes_.id());
  clear(levels_.front());
  glUseProgram(bright_.id());
  glProgramUniform4i(bright_.id(), 0, rect.x, rect.y, rect.width, rect.height);
  glProgramUniform1f(bright_.id(), 1, static_cast<float>(settings_.threshold));
  const PixelRect grown = intersect({rect.x - 2, rect.y - 2, rect.width + 4, rect.height + 4}, {0, 0, frame_width, frame_height});
  glBeginQuery(GL_ANY_SAMPLES_PASSED, any_bright_.id());
  draw(levels_.front(), object, 0, grown);
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  GLuint any = 0;
  glGetQueryObjectuiv(any_bright_.id(), GL_QUERY_RESULT, &any);
  return any != 0;
}

PixelRect GlarePass::spread(const PixelRect& rect) {
  const int r = plan_.reach_px;
  const PixelRect reach =
      intersect({rect.x - r, rect.y - r, rect.width + 2 * r, rect.height + 2 * r}, {0, 0, frame_width_, frame_height_});
  reset_state();
  glBindVertexArray(no_attributes_.id());
  glUseProgram(down_.id());
  for (int level = 1; level < plan_.bloom_levels; ++level) {
    clear(levels_[static_cast<std::size_t>(level)]);
    draw(levels_[static_cast<std::size_t>(level)], levels_[static_cast<std::size_t>(level) - 1].texture(), level, reach);
  }
  draw_streaks(reach);  // first: draw_bloom() overwrites what they start from
  draw_bloom(reach);
  return reach;
}

void GlarePass::draw_bloom(const PixelRect& reach) const {
  glUseProgram(up_.id());
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
  glBlendColor(0, 0, 0, kBloomSpread);
  for (int level = plan_.bloom_levels - 2; level >= 0; --level) {
    const auto k = static_cast<std::size_t>(level);
    glBindTextureUnit(TEXTURE_COARSER, levels_[k + 1].texture().id());
    draw(levels_[k], levels_[k + 1].texture(), level, reach);
  }
  glDisable(GL_BLEND);
}

void GlarePass::draw_streaks(const PixelRect& reach) const {
  clear(*streaks_);
  glUseProgram(streak_.id());
  for (int i = 0; i < settings_.streak_directions; ++i) {
    const double angle = glm::radians(settings_.streak_rotation_deg) + glm::two_pi<double>() * i / settings_.streak_directions;
    draw_streak({std::cos(angle), std::sin(angle)}, reach);
  }
}

void GlarePass::draw_streak(const glm::dvec2& direction, const PixelRect& reach) const {
  const double a = plan_.streak_attenuation;
  const GlTexture* source = &levels_[static_cast<std::size_t>(plan_.streak_level)].texture();
  for (int pass = 0; pass < plan_.streak_passes; ++pass) {
    const bool last = pass + 1 == plan_.streak_passes;
    const double b = std::exp2(2 * pass);
    // Each pass sums to 1, and so do all together: neither their number nor the resolution changes the brightness.
    std::array<double, 4> weights{};
    double sum = 0;
    for (int s = 0; s < 4; ++s) sum += weights[static_cast<std::size_t>(s)] = std::pow(a, b * s);
    const double scale = 1 / (sum * (last ? settings_.streak_directions : 1));
    glProgramUniform2f(streak_.id(), 0, static_cast<float>(direction.x * b), static_cast<float>(direction.y * b));
    glProgramUniform4f(streak_.id(), 1, static_cast<float>(weights[0] * scale), static_cast<float>(weights[1] * scale),
                       static_cast<float>(weights[2] * scale), static_cast<float>(weights[3] * scale));
    const ColorTarget<1>& target = last ? *streaks_ : *streak_passes_[pass % 2];
    if (last) {
      glEnable(GL_BLEND);
      glBlendEquation(GL_FUNC_ADD);
      glBlendFunc(GL_ONE, GL_ONE);
    } else {
      clear(target);
    }
    draw(target, *source, plan_.streak_level, reach);
    source = &target.texture();
  }
  glDisable(GL_BLEND);
}

glm::vec4 GlarePass::texture_from_frame() const {
  const auto per_pixel = [](const ColorTarget<1>& target, int level) {
    const float step = static_cast<float>(2 << level);
    return glm::vec2(1 / (step * static_cast<float>(target.width())), 1 / (step * static_cast<float>(target.height())));
  };
  return {per_pixel(levels_.front(), 0), per_pixel(*streaks_, plan_.streak_level)};
}

}  // namespace catchlight::render
