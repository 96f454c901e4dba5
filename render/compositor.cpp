#include "render/compositor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catchlight/error.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/tone_curve.hpp"
#include "render/camera/lens.hpp"
#include "render/gl/gl_context.hpp"
#include "render/gl/pass_clock.hpp"
#include "render/gl/shader_library.hpp"
#include "render/mesh/mesh.hpp"
#include "render/passes/composite_pass.hpp"
#include "render/passes/glare/aperture_glare_pass.hpp"
#include "render/passes/glare/glare_pass.hpp"
#include "render/passes/lens_blur_pass.hpp"
#include "render/passes/light_transfer.hpp"
#include "render/passes/object_layers.hpp"
#include "render/passes/object_pass.hpp"
#include "render/passes/receiver_pass.hpp"
#include "render/passes/shadowed_lights.hpp"
#include "render/passes/tone_pass.hpp"
#include "render/probe/light_samples.hpp"
#include "render/scene_check.hpp"

namespace catchlight::render {
namespace {

constexpr double kNear_m = 1e-3;
/// Of the object's diagonal: how far a smoothed surface may lie from its triangles.
constexpr float kSkinShare = 0.01f;

struct Box {
  glm::dvec3 min_m{std::numeric_limits<double>::max()}, max_m{std::numeric_limits<double>::lowest()};
};

Box bounding_box(const Mesh& mesh) {
  Box box;
  for (const std::uint32_t i : mesh.indices) {
    const glm::dvec3 p(mesh.vertices[i].position_m);
    box.min_m = glm::min(box.min_m, p);
    box.max_m = glm::max(box.max_m, p);
  }
  return box;
}

BoundingSphere sphere_around(const Box& box) {
  if (box.min_m.x > box.max_m.x) return {glm::vec3(0), 1.0f};
  return {glm::vec3(box.min_m + box.max_m) * 0.5f, static_cast<float>(0.5 * glm::distance(box.min_m, box.max_m))};
}

TagLight light_of(const RenderScene& scene) {
  TagLight light{scene.light, {}, scene.lights};
  if (!scene.lights.empty()) light.split_off = project_to_sh(scene.lights, scene.transfer.bands);
  return light;
}

TagLight turned(const TagLight& light, const glm::dmat3& rotation) {
  TagLight result{rotate_sh(light.whole, rotation), {}, light.samples};
  if (!light.split_off.empty()) result.split_off = rotate_sh(light.split_off, rotation);
  for (LightSample& sample : result.samples) sample.direction = rotation * sample.direction;
  return result;
}

int supported_samples(int wanted) {
  GLint limit = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &limit);
  return std::clamp(wanted, 1, static_cast<int>(limit));
}

}  // namespace

struct Compositor::Impl {
  Impl(const RenderScene& scene, const CompositorSettings& wanted);

  Composite render(const FrameView& view, const PlateReader& plate, bool want_layers, bool want_picture);
  void apply_tone(const FrameView& view, bool want_picture, Composite& result);
  void relight(const glm::dmat3& tag_from_light);
  void update_view(const FrameView& view);
  PixelRect reach(const FrameView& view) const;
  bool mirrors_receiver(const FrameView& view) const;
  void upload_plate(const PlateReader& plate, const PixelRect& rect);
  void make_targets(const PixelRect& rect, bool want_layers);
  bool divides_glare() const;
  bool draw_virtual_layer(const FrameView& view, const PixelRect& rect, const LensBlurPlan& blur);

  CompositorSettings settings;
  TagLight light_probe;  ///< as the probe's frame has it
  glm::vec3 probe_in_tag_m;
  Box box;
  PassClock clock;
  ShaderLibrary shaders;
  LightTransfer light;
  ShadowedLights lights;
  ObjectPass object;
  std::unique_ptr<ReceiverPass> receiver;
  LensBlur lens_blur;
  GlarePass glare;
  std::unique_ptr<ApertureGlarePass> aperture_glare;  ///< in its place where settings.glare.method is "fft"
  CompositePass composite;
  std::unique_ptr<TonePass> tone;  ///< null: neither a tone curve nor the classic look
  UniformBuffer<shader_interface::ViewUniforms> view_uniforms{"view"};
  std::optional<glm::dmat3> lit_from;  ///< the light's turn that the points are lit for
  std::unique_ptr<ObjectTarget> object_target;
  std::unique_ptr<ColorTarget<1>> shadow_target;
  const GlTexture *object_seen = nullptr, *shadow_seen = nullptr;  ///< as the lens shows them
  std::vector<PassTime> times;
};

Compositor::Impl::Impl(const RenderScene& scene, const CompositorSettings& wanted)
    : settings(wanted),
      light_probe(light_of(checked(scene))),
      probe_in_tag_m(scene.probe_in_tag_m),
      box(bounding_box(scene.mesh)),
      shaders(wanted.shader_folder),
      light(shaders),
      lights(static_cast<int>(scene.lights.size()), sphere_around(box), shaders),
      object(scene.mesh, LitPoints("object", scene.transfer.object, scene.transfer.object_direct, sh_count(scene.transfer.bands)),
             scene.reflections, scene.rest_reflections, shaders),
      lens_blur(shaders),
      glare(wanted.glare, shaders),
      composite(shaders) {
  settings.samples = supported_samples(wanted.samples);
  if (wanted.tone.enabled || wanted.look == Look::classic) tone = std::make_unique<TonePass>(wanted, shaders);
  if (wanted.look == Look::classic) settings.glare.enabled = false;  // that look has its own
  if (settings.glare.enabled && wanted.glare.method == "fft") aperture_glare = std::make_unique<ApertureGlarePass>(wanted.glare);
  if (scene.transfer.grid.columns >= 2 && scene.transfer.grid.rows >= 2)
    receiver = std::make_unique<ReceiverPass>(scene.transfer, shaders);
  check_gl("the compositor's start");
}

/// The light turns against the object only where the probe is fixed to the camera.
void Compositor::Impl::relight(const glm::dmat3& tag_from_light) {
  if (lit_from == tag_from_light) return;
  const auto pass = clock.pass("light");
  const TagLight light_tag = tag_from_light == glm::dmat3(1.0) ? light_probe : turned(light_probe, tag_from_light);
  light.set_light(light_tag.whole, light_tag.split_off);
  lights.update(light_tag.samples, [this] { object.draw_geometry(); });
  object.light_by(light, lights);
  if (receiver) receiver->light_by(light, light_tag, lights, box.min_m, box.max_m);
  lit_from = tag_from_light;
}

void Compositor::Impl::update_view(const FrameView& view) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = view.camera.distortion;
  const LensLimit limit = lens_limit(view.camera);
  glm::dmat4 camera_from_tag(view.camera_from_tag.rotation);
  camera_from_tag[3] = glm::dvec4(view.camera_from_tag.translation_m, 1.0);
  shader_interface::ViewUniforms block{};
  block.clip_from_camera = glm::mat4(clip_from_camera(view.camera, kNear_m));
  block.camera_from_tag = glm::mat4(camera_from_tag);
  block.light_from_tag = glm::mat4(glm::mat3(glm::transpose(view.tag_from_light)));
  block.plate_from_rec709 = glm::mat4(view.color.plate_from_rec709);
  block.camera_in_tag_m = glm::vec4(glm::vec3(inverse(view.camera_from_tag).translation_m), 1.0f);
  block.exposure = glm::vec4(view.exposure, 0.0f);
  block.radial_numerator = glm::vec4(k1, k2, k3, 0);
  block.radial_denominator = glm::vec4(k4, k5, k6, 0);
  block.tangential = glm::vec4(p1, p2, 0, 0);
  block.lens_limit = glm::vec4(limit.radius, limit.distorted, limit.slope, 0);
  block.frame = glm::vec4(view.camera.width_px, view.camera.height_px, view.camera.fx_px, 0);
  block.probe_in_tag_m = glm::vec4(probe_in_tag_m, kSkinShare * static_cast<float>(glm::distance(box.min_m, box.max_m)));
  block.options = {settings.reflection_rays, mirrors_receiver(view) ? 1 : 0, 0, 0};
  view_uniforms.update(block);
  view_uniforms.bind(BINDING_VIEW);
}

/// Pixels that object or shadow may touch.
PixelRect Compositor::Impl::reach(const FrameView& view) const {
  PixelRect rect;
  if (box.min_m.x <= box.max_m.x) rect = visible_rect(view.camera, view.camera_from_tag, box.min_m, box.max_m, kNear_m);
  const bool sees_front = inverse(view.camera_from_tag).translation_m.z > 0;
  if (receiver && sees_front) {
    const glm::dvec3 min_m(receiver->reach().min_m, 0.0), max_m(receiver->reach().max_m, 0.0);
    rect = unite(rect, visible_rect(view.camera, view.camera_from_tag, min_m, max_m, kNear_m));
  }
  return rect;
}

/// A mirror shows the receiver where the camera does.
bool Compositor::Impl::mirrors_receiver(const FrameView& view) const {
  return settings.reflection_rays > 0 && receiver && object.reflects() && inverse(view.camera_from_tag).translation_m.z > 0;
}

void Compositor::Impl::make_targets(const PixelRect& rect, bool want_layers) {
  const int width = roomy(rect.width), height = roomy(rect.height);
  if (!object_target || !object_target->fits(width, height, want_layers)) {
    object_target = std::make_unique<ObjectTarget>(width, height, settings.samples, want_layers, divides_glare());
  }
  if (!shadow_target || !shadow_target->fits(width, height))
    shadow_target = std::make_unique<ColorTarget<1>>("shadow", GL_RGBA32F, width, height);
}

/// What the object emits glares otherwise than what it reflects.
bool Compositor::Impl::divides_glare() const {
  const GlareSettings& g = settings.glare;
  return g.enabled && object.emits() &&
         (g.emitter_strength != 1 || (g.emitter_directions != 0 && g.emitter_directions != g.streak_directions));
}

/// Object, shadow and what glares of them. True if anything does.
bool Compositor::Impl::draw_virtual_layer(const FrameView& view, const PixelRect& rect, const LensBlurPlan& blur) {
  const int width = view.camera.width_px, height = view.camera.height_px;
  {
    const auto pass = clock.pass("object");
    if (receiver) receiver->bind();
    lights.bind();
    glBindTextureUnit(TEXTURE_PLATE_LIGHT, composite.plate_light().id());
    object.draw(*object_target, rect, width, height);
  }
  {
    const auto pass = clock.pass("receiver");
    const float no_shadow[4] = {1, 1, 1, 1};
    glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(shadow_target->framebuffer(), GL_COLOR, 0, no_shadow);
    if (receiver && inverse(view.camera_from_tag).translation_m.z > 0) receiver->draw(*shadow_target, rect, width, height);
  }
  object_seen = &object_target->color(), shadow_seen = &shadow_target->texture();
  if (!blur.empty()) {
    const auto pass = clock.pass("lens blur");
    lens_blur.apply(blur, *object_seen, *shadow_seen, rect);
    object_seen = &lens_blur.object(), shadow_seen = &lens_blur.shadow();
  }
  if (!settings.glare.enabled) return false;
  const auto pass = clock.pass("highlights");
  if (aperture_glare) return aperture_glare->extract(*object_seen, rect, width, height);
  const GlTexture* emission = divides_glare() ? &object_target->emission() : nullptr;
  return glare.extract(*object_seen, emission, rect, width, height);
}

void Compositor::Impl::upload_plate(const PlateReader& plate, const PixelRect& rect) {
  const auto pass = clock.pass("plate");
  const Plate result = plate(rect);
  if (result.rect != rect) throw Error("the plate reader gave another rectangle than it was asked for");
  composite.upload(result);
}

/// The whole frame, drawn as linear light, becomes codes.
void Compositor::Impl::apply_tone(const FrameView& view, bool want_picture, Composite& result) {
  const int width = view.camera.width_px, height = view.camera.height_px;
  {
    const auto pass = clock.pass("meter");
    result.tone_wanted = tone->meter(composite.drawn(), width, height, view.color);
  }
  if (!want_picture) return;
  const auto pass = clock.pass("tone");
  tone->draw_glare(composite.drawn(), width, height);
  tone->draw(composite.drawn(), width, height, view.color, view.tone.value_or(result.tone_wanted));
  result.rgba = tone->read();
}

Composite Compositor::Impl::render(const FrameView& view, const PlateReader& plate, bool want_layers, bool want_picture) {
  check_view(view);
  clock.begin_frame();
  times.clear();
  const PixelRect whole{0, 0, view.camera.width_px, view.camera.height_px};
  const bool is_toned = tone && !want_layers;
  if (view.has_pose) relight(view.tag_from_light);
  PixelRect virtual_rect = view.has_pose ? reach(view) : PixelRect{};
  Composite result;
  if (virtual_rect.empty() && !want_layers && !is_toned) return result;

  bool glares = false, has_whole_plate = false;
  PixelRect output_rect = virtual_rect;
  if (!virtual_rect.empty()) {
    const LensBlurPlan blur = plan_lens_blur(view, box.min_m, box.max_m);
    const int r = blur.reach_px(virtual_rect);
    virtual_rect =
        intersect({virtual_rect.x - r, virtual_rect.y - r, virtual_rect.width + 2 * r, virtual_rect.height + 2 * r}, whole);
    output_rect = virtual_rect;
    update_view(view);
    if (mirrors_receiver(view)) {
      upload_plate(plate, whole);
      const auto pass = clock.pass("plate light");
      composite.draw_plate_light(view);
      has_whole_plate = true;
    }
    make_targets(virtual_rect, want_layers);
    glares = draw_virtual_layer(view, virtual_rect, blur);
    if (glares) {
      const auto pass = clock.pass("glare");
      result.glare_rect = aperture_glare ? aperture_glare->spread(view.camera) : glare.spread();
      output_rect = unite(virtual_rect, result.glare_rect);
    }
  }
  if (want_layers || is_toned) output_rect = whole;

  if (!has_whole_plate) upload_plate(plate, output_rect);
  {
    const auto pass = clock.pass("composite");
    composite.draw(view, output_rect,
                   {virtual_rect, object_seen, shadow_seen, glares ? &glare : nullptr,
                    glares && aperture_glare ? &aperture_glare->glare() : nullptr},
                   want_layers, is_toned);
  }
  result.rect = output_rect;
  if (is_toned)
    apply_tone(view, want_picture, result);
  else
    result.rgba = composite.read();
  result.glare_drawn = glares;
  if (want_layers) {
    Layers& layers = result.layers.emplace();
    composite.read_layers(layers);
    read_object_layers(object_target.get(), virtual_rect, whole, layers);
  }
  check_gl("a frame");
  times = clock.times();
  return result;
}

Compositor::Compositor(const RenderScene& scene, const CompositorSettings& settings)
    : impl_(std::make_unique<Impl>(scene, settings)) {}
Compositor::~Compositor() = default;
Compositor::Compositor(Compositor&&) noexcept = default;
Compositor& Compositor::operator=(Compositor&&) noexcept = default;

Composite Compositor::render(const FrameView& view, const PlateReader& plate, bool want_layers) {
  return impl_->render(view, plate, want_layers, true);
}

ToneCurve Compositor::meter(const FrameView& view, const PlateReader& plate) {
  return impl_->render(view, plate, false, false).tone_wanted;
}

const std::vector<PassTime>& Compositor::pass_times() const {
  return impl_->times;
}

std::vector<std::string> Compositor::reload_shaders() {
  impl_->lit_from.reset();  // what is drawn once and kept is drawn with the new programs too
  return impl_->shaders.reload();
}

}  // namespace catchlight::render
