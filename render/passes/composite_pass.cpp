#include "render/passes/composite_pass.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/response.hpp"
#include "render/gl/read_back.hpp"

namespace catchlight::render {
namespace {

struct PlateFormat {
  GLenum internal, type;
  std::size_t channel_bytes;
  bool clips;          ///< codes end at 1
  float changed_code;  ///< a quarter of a code of 8 bits, or of 12 where there may be more
};

PlateFormat describe(Plate::Format format) {
  switch (format) {
    case Plate::Format::rgb_u8:
      return {GL_RGB8, GL_UNSIGNED_BYTE, 1, true, 0.25f / 255};
    case Plate::Format::rgb_u16:
      return {GL_RGB16, GL_UNSIGNED_SHORT, 2, true, 0.25f / 4095};
    case Plate::Format::rgb_f32:
      return {GL_RGB32F, GL_FLOAT, 4, false, 0.25f / 4095};
  }
  throw Error("unknown plate format");
}

int mode_of(const PlateColor& color) {
  if (color.curve) return TRANSFER_CURVE;
  switch (color.transfer) {
    case TransferFunction::srgb:
      return TRANSFER_SRGB;
    case TransferFunction::linear:
      return TRANSFER_LINEAR;
    case TransferFunction::gamma22:
      return TRANSFER_GAMMA22;
    case TransferFunction::gamma28:
      return TRANSFER_GAMMA28;
    case TransferFunction::pq:
      return TRANSFER_PQ;
    case TransferFunction::hlg:
      return TRANSFER_HLG;
  }
  throw Error("unknown transfer function");
}

/// Vignetting in the form of CompositeUniforms.
struct Vignetting {
  glm::vec4 terms{0, 0, 0, 1}, at{0};
};

Vignetting vignetting_of(const CameraModel& camera, double passed_at_tag) {
  if (camera.vignetting == glm::dvec3(0.0) || !(passed_at_tag > 0)) return {};
  return {glm::vec4(camera.vignetting, 1 / passed_at_tag),
          glm::vec4(camera.cx_px, camera.cy_px, 1 / half_diagonal_px2(camera), 0)};
}

glm::ivec4 as_vector(const PixelRect& rect) {
  return {rect.x, rect.y, rect.width, rect.height};
}

}  // namespace

CompositePass::CompositePass(ShaderLibrary& shaders)
    : program_(shaders.program(fullscreen("composite.frag"))),
      plate_light_program_(shaders.program(fullscreen("plate_light.frag"))),
      black_(make_texture_2d("black", GL_RGBA8, 1, 1)) {
  glClearTexImage(black_.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
}

void CompositePass::upload(const Plate& plate) {
  const PlateFormat format = describe(plate.format);
  const std::size_t expected =
      static_cast<std::size_t>(plate.rect.width) * static_cast<std::size_t>(plate.rect.height) * 3 * format.channel_bytes;
  if (plate.pixels.size() != expected) {
    throw Error("the plate's rectangle of " + std::to_string(plate.rect.width) + " x " + std::to_string(plate.rect.height) +
                " pixels needs " + std::to_string(expected) + " bytes, got " + std::to_string(plate.pixels.size()));
  }
  if (plate_format_ != format.internal || plate.rect.width > plate_width_ || plate.rect.height > plate_height_) {
    plate_width_ = roomy(std::max(plate.rect.width, plate_width_));
    plate_height_ = roomy(std::max(plate.rect.height, plate_height_));
    plate_format_ = format.internal;
    plate_ = make_texture_2d("plate", format.internal, plate_width_, plate_height_);
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(plate_.id(), 0, 0, 0, plate.rect.width, plate.rect.height, GL_RGB, format.type, plate.pixels.data());
  plate_rect_ = plate.rect;
  clips_ = format.clips;
  changed_code_ = format.changed_code;
}

/// The channels' tables one after the other.
void CompositePass::upload_curve(const std::shared_ptr<const ResponseCurve>& curve) {
  if (curve && curve != uploaded_curve_) {
    std::vector<float> light;
    for (const std::vector<float>& channel : curve->light()) light.insert(light.end(), channel.begin(), channel.end());
    response_ = make_buffer("response", std::span<const float>(light));
    uploaded_curve_ = curve;
  }
  if (curve) bind_storage(BINDING_RESPONSE, response_.id());
}

void CompositePass::update_uniforms(const FrameView& view, const VirtualLayer& layer, bool as_light) {
  shader_interface::CompositeUniforms block{};
  block.output_rect = as_vector(rect_);
  block.virtual_rect = as_vector(layer.rect);
  block.plate_rect = as_vector(plate_rect_);
  block.modes = {mode_of(view.color), clips_ ? 1 : 0, layer.pixel_glare ? 2 : layer.glare ? 1 : 0, as_light ? 1 : 0};
  block.black = glm::vec4(view.black, 0);
  block.receiver_light = glm::vec4(view.receiver_light, 0);
  block.code_limits = {changed_code_, static_cast<float>(kClippingCode), 0, 0};
  const Vignetting vignetting = vignetting_of(view.camera, layer.passed_at_tag);
  block.vignetting = vignetting.terms;
  block.vignetting_at = vignetting.at;
  const SensorNoise& noise = view.effects.noise;
  block.noise = {noise.enabled ? 1 : 0, static_cast<int>(noise.frame), noise.block_shift.x, noise.block_shift.y};
  block.noise_slope = glm::vec4(noise.slope, 0);
  block.noise_floor = glm::vec4(noise.floor, 0);
  block.noise_mix = glm::mat4(noise.mix);
  if (layer.glare && !layer.pixel_glare) block.glare_from_frame = layer.glare->texels_from_frame();
  uniforms_.update(block);
  uniforms_.bind(BINDING_COMPOSITE);
  upload_curve(view.color.curve);
}

void CompositePass::draw_plate_light(const FrameView& view) {
  const int width = plate_rect_.width, height = plate_rect_.height;
  if (plate_light_width_ != width || plate_light_height_ != height) {
    plate_light_ = make_mipmapped_texture_2d("plate light", GL_RGBA16F, width, height);
    plate_light_framebuffer_ = make_framebuffer("plate light");
    glNamedFramebufferTexture(plate_light_framebuffer_.id(), GL_COLOR_ATTACHMENT0, plate_light_.id(), 0);
    plate_light_width_ = width, plate_light_height_ = height;
  }
  update_uniforms(view, {}, false);
  glBindTextureUnit(TEXTURE_PLATE, plate_.id());
  draw_.over({0, 0, width, height}, plate_light_framebuffer_.id(), plate_light_program_);
  glGenerateTextureMipmap(plate_light_.id());
}

void CompositePass::draw(const FrameView& view, const PixelRect& rect, const VirtualLayer& layer, bool with_layers,
                         bool as_light) {
  rect_ = rect;
  const int width = roomy(rect_.width), height = roomy(rect_.height);
  if (with_layers && !(layers_ && layers_->fits(width, height))) {
    layers_ = std::make_unique<ColorTarget<kOutputs>>("layers", GL_RGBA32F, width, height);
  }
  if (!with_layers && !(output_ && output_->fits(width, height)))
    output_ = std::make_unique<ColorTarget<1>>("composite", GL_RGBA32F, width, height);
  drawn_framebuffer_ = with_layers ? layers_->framebuffer() : output_->framebuffer();
  update_uniforms(view, layer, as_light);
  glBindTextureUnit(TEXTURE_OBJECT, (layer.object ? *layer.object : black_).id());
  glBindTextureUnit(TEXTURE_SHADOW, (layer.shadow ? *layer.shadow : black_).id());
  glBindTextureUnit(TEXTURE_PLATE, plate_.id());
  const GlTexture& glare = layer.pixel_glare ? *layer.pixel_glare : layer.glare ? layer.glare->glare() : black_;
  glBindTextureUnit(TEXTURE_GLARE, glare.id());
  glBindTextureUnit(TEXTURE_REFLECTION, (layer.reflection ? *layer.reflection : black_).id());
  draw_.over({0, 0, rect_.width, rect_.height}, drawn_framebuffer_, program_);
}

RawVector<float> CompositePass::read() const {
  return read_back(drawn_framebuffer_, 0, rect_.width, rect_.height, 4).data;
}

void CompositePass::read_layers(Layers& layers) const {
  const auto read = [&](int output, int channels) {
    return read_back(layers_->framebuffer(), output, rect_.width, rect_.height, channels);
  };
  layers.plate = read(1, 3), layers.object = read(2, 4), layers.shadow = read(3, 3);
  layers.glare = read(4, 3), layers.reflection = read(5, 3);
}

}  // namespace catchlight::render
