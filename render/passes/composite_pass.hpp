// Puts object, shadow and glare into the plate and reads the result back.
#pragma once

#include <memory>

#include "catchlight/composite.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "render/frame_view.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/render_target.hpp"
#include "render/gl/shader_library.hpp"
#include "render/passes/glare/glare_pass.hpp"
#include "shaders/interface.h"

namespace catchlight::render {

/// What is put into the plate. The textures hold the frame's pixels of `rect`; an empty rect leaves them unread.
struct VirtualLayer {
  PixelRect rect;
  const GlTexture* object;
  const GlTexture* shadow;
  const GlarePass* glare;                  ///< null: none drawn
  const GlTexture* reflection = nullptr;   ///< the mirrored part of the object; only with layers
  const GlTexture* pixel_glare = nullptr;  ///< stands for it where not null: glare of every pixel of the frame
  double passed_at_tag = 0;  ///< share of light that vignetting leaves at the tag, where exposure is matched; 0: unknown
};

class CompositePass {
 public:
  explicit CompositePass(ShaderLibrary& shaders);

  /// Throws Error if the plate is not of its rectangle's size.
  void upload(const Plate& plate);

  /// The uploaded plate as the light that it photographed, for mirrors. Needs the ViewUniforms bound.
  void draw_plate_light(const FrameView& view);
  const GlTexture& plate_light() const { return plate_light_; }

  /// Draws the composite over `rect`, which the uploaded plate holds. `as_light`: linear instead of codes, for the tone curve to
  /// go on from.
  void draw(const FrameView& view, const PixelRect& rect, const VirtualLayer& layer, bool with_layers, bool as_light = false);

  /// The last draw without layers: `rect` in the first texels.
  const GlTexture& drawn() const { return output_->texture(); }

  /// The last draw's codes and change flags, RGBA.
  RawVector<float> read() const;

  /// Plate, object, shadow, glare and reflection of the last draw with layers.
  void read_layers(Layers& layers) const;

 private:
  static constexpr int kOutputs = 6;

  void upload_curve(const std::shared_ptr<const ResponseCurve>& curve);
  void update_uniforms(const FrameView& view, const VirtualLayer& layer, bool as_light);

  Program &program_, &plate_light_program_;
  FullscreenDraw draw_;
  UniformBuffer<shader_interface::CompositeUniforms> uniforms_{"composite"};
  GlTexture plate_, plate_light_, black_;
  GlBuffer response_;
  std::shared_ptr<const ResponseCurve> uploaded_curve_;
  GlFramebuffer plate_light_framebuffer_;
  GLenum plate_format_ = 0;
  int plate_width_ = 0, plate_height_ = 0;
  bool clips_ = true;
  float changed_code_ = 0;
  PixelRect plate_rect_, rect_;
  int plate_light_width_ = 0, plate_light_height_ = 0;
  std::unique_ptr<ColorTarget<1>> output_;
  std::unique_ptr<ColorTarget<kOutputs>> layers_;
  GLuint drawn_framebuffer_ = 0;
};

}  // namespace catchlight::render
