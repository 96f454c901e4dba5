// Pixels from the GPU.
#pragma once

#include "catchlight/image.hpp"
#include "render/gl/gl_objects.hpp"

namespace catchlight::render {

/// The first width x height pixels of a framebuffer's colour attachment, 3 or 4 channels. Waits for the GPU.
inline Image read_back(GLuint framebuffer, int attachment, int width, int height, int channels) {
  Image image(width, height, channels);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glNamedFramebufferReadBuffer(framebuffer, static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + attachment));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, channels == 4 ? GL_RGBA : GL_RGB, GL_FLOAT, image.data.data());
  return image;
}

}  // namespace catchlight::render
