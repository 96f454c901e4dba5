// Draws the shadow on the receiving plane as a ratio of light.
#pragma once

#include <string>

#include "render/light_transfer.hpp"
#include "render/render_target.hpp"
#include "render/transfer.hpp"

namespace catchlight::render {

class ReceiverPass {
 public:
  /// `transfer` must have a grid of at least 2 x 2 points.
  ReceiverPass(const Transfer& transfer, const std::string& shader_folder);

  /// The points' irradiance under `light`; needed again whenever the light turns.
  void light_by(const LightTransfer& light, const ShRgb& light_tag);

  /// For shaders that include receiver.glsl.
  void bind() const;

  /// Ratios within `rect` (pixels of a frame of that size) into `target`, 1 beside the grid. Needs the ViewUniforms bound.
  void draw(const ColorTarget<1>& target, const PixelRect& rect, int frame_width, int frame_height) const;

 private:
  ReceiverGrid grid_;
  std::vector<float> unshadowed_;
  GlProgram program_;
  GlVertexArray no_attributes_;
  LitPoints points_;
  GlTexture irradiance_;
  UniformBuffer<shader_interface::ReceiverUniforms> uniforms_{"receiver"};
};

}  // namespace catchlight::render
