#include "render/passes/tone_pass.hpp"

#include "render/gl/read_back.hpp"
#include "render/gl/shader.hpp"
#include "shaders/interface.h"

namespace catchlight::render {

ToneMeter::ToneMeter(const std::string& shader_folder)
    : program_(make_program({.vertex = "fullscreen.vert", .fragment = "tone_meter.frag", .captured = {}}, shader_folder)),
      no_attributes_(make_vertex_array("no attributes")),
      bins_(make_buffer("luminances", sizeof(LuminanceHistogram::bins), nullptr)),
      nothing_(make_framebuffer("luminances")) {}

LuminanceHistogram ToneMeter::measure(const GlTexture& light, int width, int height, const glm::dvec3& luminance_weights) {
  glClearNamedBufferData(bins_.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  reset_state();
  glNamedFramebufferParameteri(nothing_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, width);
  glNamedFramebufferParameteri(nothing_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, height);
  glBindFramebuffer(GL_FRAMEBUFFER, nothing_.id());
  glViewport(0, 0, width, height);
  glUseProgram(program_.id());
  glBindVertexArray(no_attributes_.id());
  const glm::vec3 weights(luminance_weights);
  glProgramUniform3f(program_.id(), 0, weights.x, weights.y, weights.z);
  glBindTextureUnit(TEXTURE_SOURCE, light.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LUMINANCES, bins_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  LuminanceHistogram histogram;
  glGetNamedBufferSubData(bins_.id(), 0, sizeof histogram.bins, histogram.bins.data());
  return histogram;
}

TonePass::TonePass(const CompositorSettings& settings, const std::string& shader_folder)
    : settings_(settings.tone),
      glare_(settings.glare),
      meter_(shader_folder),
      program_(make_program({.vertex = "fullscreen.vert", .fragment = "tone.frag", .captured = {}}, shader_folder)),
      no_attributes_(make_vertex_array("no attributes")),
      black_(make_texture_2d("black", GL_RGBA8, 1, 1)) {
  glClearTexImage(black_.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  if (settings.look == Look::classic && glare_.enabled) classic_ = std::make_unique<ClassicLook>(shader_folder);
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
  reset_state();
  glBindFramebuffer(GL_FRAMEBUFFER, output_->framebuffer());
  glViewport(0, 0, width, height);
  glUseProgram(program_.id());
  glBindVertexArray(no_attributes_.id());
  const glm::vec3 weights(luminance_weights(color.plate_from_rec709));
  const double one_over_white = 1 / curve.white;
  glProgramUniform2f(program_.id(), 0, static_cast<float>(curve.gain), static_cast<float>(one_over_white * one_over_white));
  glProgramUniform3f(program_.id(), 1, weights.x, weights.y, weights.z);
  glProgramUniform2f(program_.id(), 2, classic_ ? static_cast<float>(glare_.bloom_strength) : 0,
                     classic_ ? static_cast<float>(glare_.streak_strength) : 0);
  glProgramUniform2f(program_.id(), 3, 1 / static_cast<float>(width), 1 / static_cast<float>(height));
  glBindTextureUnit(TEXTURE_SOURCE, light.id());
  glBindTextureUnit(TEXTURE_BLOOM, (classic_ ? classic_->bloom() : black_).id());
  glBindTextureUnit(TEXTURE_STREAKS, (classic_ ? classic_->streaks() : black_).id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

std::vector<float> TonePass::read() const {
  return read_back(output_->framebuffer(), 0, width_, height_, 4).data;
}

}  // namespace catchlight::render
