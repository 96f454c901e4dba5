#include "render/passes/tone_pass.hpp"

#include "render/gl/read_back.hpp"
#include "render/glare/glare_plan.hpp"
#include "shaders/interface.h"

namespace catchlight::render {

ToneMeter::ToneMeter(ShaderLibrary& shaders)
    : program_(shaders.program(fullscreen("tone_meter.frag"))),
      bins_(make_buffer("luminances", sizeof(LuminanceHistogram::bins), nullptr)),
      nothing_(make_framebuffer("luminances")) {}

LuminanceHistogram ToneMeter::measure(const GlTexture& light, int width, int height, const glm::dvec3& luminance_weights) {
  glClearNamedBufferData(bins_.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  glNamedFramebufferParameteri(nothing_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, width);
  glNamedFramebufferParameteri(nothing_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, height);
  program_.set("luminance_weights", glm::vec3(luminance_weights));
  glBindTextureUnit(TEXTURE_SOURCE, light.id());
  bind_storage(BINDING_LUMINANCES, bins_.id());
  draw_.over({0, 0, width, height}, nothing_.id(), program_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  LuminanceHistogram histogram;
  glGetNamedBufferSubData(bins_.id(), 0, sizeof histogram.bins, histogram.bins.data());
  return histogram;
}

TonePass::TonePass(const CompositorSettings& settings, ShaderLibrary& shaders)
    : settings_(settings.tone),
      glare_(settings.glare),
      meter_(shaders),
      program_(shaders.program(fullscreen("tone.frag"))),
      black_(make_texture_2d("black", GL_RGBA8, 1, 1)) {
  glClearTexImage(black_.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  if (settings.look == Look::classic && glare_.enabled) classic_ = std::make_unique<ClassicLook>(shaders);
}

ToneCurve TonePass::meter(const GlTexture& light, int width, int height, const PlateColor& color) {
  if (!settings_.enabled) return {};
  const glm::dvec3 weights = luminance_weights(color.plate_from_rec709);
  return tone_curve(scene_luminance(meter_.measure(light, width, height, weights)), settings_);
}

void TonePass::draw_glare(const GlTexture& light, int width, int height) {
  if (classic_) classic_->draw(light, width, height, glare_.threshold, classic_attenuation(glare_.streak_attenuation));
}

void TonePass::draw(const GlTexture& light, int width, int height, const PlateColor& color, const ToneCurve& curve) {
  width_ = width, height_ = height;
  if (!(output_ && output_->fits(width, height)))
    output_ = std::make_unique<ColorTarget<1>>("tone", GL_RGBA32F, roomy(width), roomy(height));
  const double one_over_white = 1 / curve.white;
  program_.set("curve", glm::vec2(curve.gain, one_over_white * one_over_white));
  program_.set("luminance_weights", glm::vec3(luminance_weights(color.plate_from_rec709)));
  program_.set("glare_strength", classic_ ? glm::vec2(glare_.bloom_strength, glare_.streak_strength) : glm::vec2(0));
  program_.set("one_over_frame", 1.0f / glm::vec2(width, height));
  glBindTextureUnit(TEXTURE_SOURCE, light.id());
  glBindTextureUnit(TEXTURE_BLOOM, (classic_ ? classic_->bloom() : black_).id());
  glBindTextureUnit(TEXTURE_STREAKS, (classic_ ? classic_->streaks() : black_).id());
  draw_.over({0, 0, width, height}, output_->framebuffer(), program_);
}

RawVector<float> TonePass::read() const {
  return read_back(output_->framebuffer(), 0, width_, height_, 4).data;
}

}  // namespace catchlight::render
