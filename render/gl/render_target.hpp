// What the passes draw into. Targets cover a rectangle of the frame, not the frame: their texel (0, 0) is that rectangle's
// corner.
#pragma once

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/gl/gl_objects.hpp"

namespace catchlight::render {

/// Multisampled object colour with depth, and what they resolve to.
class ObjectTarget {
 public:
  static constexpr int kLayers = 4;

  /// `with_layers` adds reflection, and normal with depth; `with_emission` the light that the object emits.
  ObjectTarget(int width, int height, int samples, bool with_layers, bool with_emission);

  bool fits(int width, int height, bool with_layers) const {
    return width <= width_ && height <= height_ && (with_layers_ || !with_layers);
  }
  GLuint framebuffer() const { return multisampled_.id(); }

  /// Averages the samples of the first width x height pixels.
  void resolve(int width, int height) const;

  /// The first width x height pixels of layer 0 (colour), 1 (reflection) or 2 (normal and depth), RGBA.
  Image read(int layer, int width, int height) const;

  /// The layers after resolve(), premultiplied by coverage.
  const GlTexture& color() const { return resolved_textures_[0]; }
  const GlTexture& reflection() const { return resolved_textures_[1]; }
  const GlTexture& normal_depth() const { return resolved_textures_[2]; }
  const GlTexture& emission() const { return resolved_textures_[3]; }

 private:
  bool has(int layer) const { return layer == 0 || (layer == 3 ? with_emission_ : with_layers_); }

  int width_, height_;
  bool with_layers_, with_emission_;
  GlFramebuffer multisampled_, resolved_;
  GlRenderbuffer multisampled_colors_[kLayers], depth_;
  GlTexture resolved_textures_[kLayers];
};

/// One or more float textures of one size, drawn to together.
template <int kCount>
class ColorTarget {
 public:
  ColorTarget(const std::string& label, GLenum format, int width, int height, GLenum filter = GL_NEAREST)
      : width_(width), height_(height), framebuffer_(make_framebuffer(label)) {
    GLenum attachments[kCount];
    for (int i = 0; i < kCount; ++i) {
      textures_[i] = make_texture_2d(label, format, width, height, filter);
      attachments[i] = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i);
      glNamedFramebufferTexture(framebuffer_.id(), attachments[i], textures_[i].id(), 0);
    }
    glNamedFramebufferDrawBuffers(framebuffer_.id(), kCount, attachments);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  bool fits(int width, int height) const { return width <= width_ && height <= height_; }
  GLuint framebuffer() const { return framebuffer_.id(); }
  const GlTexture& texture(int i = 0) const { return textures_[i]; }

 private:
  int width_, height_;
  GlFramebuffer framebuffer_;
  GlTexture textures_[kCount];
};

/// The size of a buffer that follows a moving rectangle: it grows in steps, so that buffers are seldom made anew.
inline int roomy(int pixels) {
  return (pixels + 63) / 64 * 64;
}

/// Sets the viewport so that pixel (0, 0) of the frame falls on texel (-rect.x, -rect.y), and the scissor to the rectangle.
void set_viewport(const PixelRect& rect, int frame_width, int frame_height);

/// The GL state that passes start from: no blending, no depth test, no scissor, no culling.
void reset_state();

}  // namespace catchlight::render
