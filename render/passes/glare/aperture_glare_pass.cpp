#include "render/passes/glare/aperture_glare_pass.hpp"

#include <algorithm>

namespace catchlight::render {
namespace {

/// The rectangle around all that is not 0.
PixelRect bounds_of(const Image& image) {
  int left = image.width, right = -1, top = image.height, bottom = -1;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* rgb = image.pixel(x, y);
      if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = y;
    }
  return right < left ? PixelRect{} : PixelRect{left, top, right - left + 1, bottom - top + 1};
}

}  // namespace

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
  return bounds_of(glare);
}

}  // namespace catchlight::render
