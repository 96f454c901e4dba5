#include "render/passes/glare/aperture_glare_pass.hpp"

namespace catchlight::render {
ApertureGlarePass::ApertureGlarePass(const GlareSettings& settings) : settings_(settings), glare_(settings) {}

bool ApertureGlarePass::extract(const GlTexture& object, const PixelRect& rect, int frame_width, int frame_height) {
  Image light(rect.width, rect.height, 4);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureSubImage(object.id(), 0, 0, 0, 0, rect.width, rect.height, 1, GL_RGBA, GL_FLOAT,
                       static_cast<GLsizei>(light.data.size() * sizeof(float)), light.data.data());
  excess_ = excess_of(light, rect, frame_width, frame_height, settings_);
  return excess_.has_value();
}

PixelRect ApertureGlarePass::spread(const CameraModel& camera) {
  const Image glare = glare_.spread(*excess_, camera);
  if (width_ != glare.width || height_ != glare.height) {
    width_ = glare.width, height_ = glare.height;
    texture_ = make_texture_2d("aperture glare", GL_RGB32F, width_, height_);
  }
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture_.id(), 0, 0, 0, width_, height_, GL_RGB, GL_FLOAT, glare.data.data());
  return lit_pixels(glare);
}

}  // namespace catchlight::render
