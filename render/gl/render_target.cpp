#include "render/gl/render_target.hpp"

#include "catchlight/error.hpp"
#include "render/gl/read_back.hpp"

namespace catchlight::render {
namespace {

// 32 bits a channel: exposed highlights of real suns exceed half's 65504, and 10-bit plates need more than half's 11 bits.
constexpr GLenum kColorFormat = GL_RGBA32F;

}  // namespace

ObjectTarget::ObjectTarget(int width, int height, int samples, bool with_layers, bool with_emission)
    : width_(width),
      height_(height),
      with_layers_(with_layers),
      with_emission_(with_emission),
      multisampled_(make_framebuffer("object samples")),
      resolved_(make_framebuffer("object")) {
  GLenum drawn[kLayers] = {GL_NONE, GL_NONE, GL_NONE, GL_NONE};
  for (int i = 0; i < kLayers; ++i) {
    if (!has(i)) continue;
    drawn[i] = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i);
    multisampled_colors_[i] = make_renderbuffer("object samples", kColorFormat, width, height, samples);
    resolved_textures_[i] = make_texture_2d("object", kColorFormat, width, height);
    glNamedFramebufferRenderbuffer(multisampled_.id(), drawn[i], GL_RENDERBUFFER, multisampled_colors_[i].id());
    glNamedFramebufferTexture(resolved_.id(), drawn[i], resolved_textures_[i].id(), 0);
  }
  depth_ = make_renderbuffer("object depth", GL_DEPTH_COMPONENT32F, width, height, samples);
  glNamedFramebufferRenderbuffer(multisampled_.id(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.id());
  glNamedFramebufferDrawBuffers(multisampled_.id(), kLayers, drawn);
  if (glCheckNamedFramebufferStatus(multisampled_.id(), GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("this OpenGL cannot draw to float buffers with " + std::to_string(samples) + " samples a pixel; ask for fewer");
  }
}

void ObjectTarget::resolve(int width, int height) const {
  glDisable(GL_SCISSOR_TEST);
  for (int i = 0; i < kLayers; ++i) {
    if (!has(i)) continue;
    const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i);
    glNamedFramebufferReadBuffer(multisampled_.id(), attachment);
    glNamedFramebufferDrawBuffer(resolved_.id(), attachment);
    glBlitNamedFramebuffer(multisampled_.id(), resolved_.id(), 0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                           GL_NEAREST);
  }
}

Image ObjectTarget::read(int layer, int width, int height) const {
  return read_back(resolved_.id(), layer, width, height, 4);
}

void set_viewport(const PixelRect& rect, int frame_width, int frame_height) {
  glViewport(-rect.x, -rect.y, frame_width, frame_height);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, rect.width, rect.height);
}

void reset_state() {
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace catchlight::render
