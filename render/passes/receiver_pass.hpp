// Draws the shadow on the receiving plane as a ratio of light.
#pragma once

#include <memory>

#include "catchlight/pixel_rect.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/render_target.hpp"
#include "render/gl/shader_library.hpp"
#include "render/mesh/bounds.hpp"
#include "render/passes/light_transfer.hpp"
#include "render/passes/shadowed_lights.hpp"
#include "render/split_light.hpp"
#include "render/transfer/plane_rect.hpp"
#include "render/transfer/transfer.hpp"

namespace catchlight::render {

class ReceiverPass {
 public:
  /// `transfer` must have a grid of at least 2 x 2 points.
  ReceiverPass(const Transfer& transfer, ShaderLibrary& shaders);

  /// Finds the plane's irradiance under `light`, which `transfer` holds too; needed again whenever the light turns. `lights`
  /// casts the shadows of what lies in the box.
  void light_by(const LightTransfer& transfer, const SplitLight& light, const ShadowedLights& lights, const Bounds& box);

  /// The part of the plane that may be in shadow.
  const PlaneRect& reach() const { return reach_; }

  /// Binds what shaders need that include receiver.glsl.
  void bind() const;

  /// Draws ratios within `rect` (pixels of a frame of that size) into `target`, 1 beside the reach. Needs the ViewUniforms bound.
  void draw(const ColorTarget<1>& target, const PixelRect& rect, int frame_width, int frame_height) const;

 private:
  void draw_lights(const PlaneRect& rect, const ShadowedLights& lights, const Bounds& box);

  ReceiverGrid grid_;
  std::vector<float> unshadowed_;
  Program &program_, &lights_program_;
  FullscreenDraw draw_;
  GlVertexArray no_attributes_;
  LitPoints points_;
  GlTexture irradiance_;
  std::unique_ptr<ColorTarget<1>> light_;  ///< irradiance / pi of the lights; none without any
  PlaneRect reach_;
  shader_interface::ReceiverUniforms block_{};
  UniformBuffer<shader_interface::ReceiverUniforms> uniforms_{"receiver"};
};

}  // namespace catchlight::render
