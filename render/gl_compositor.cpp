#include "render/gl_compositor.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/error.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/tone_curve.hpp"
#include "render/camera/clip_from_camera.hpp"
#include "render/frame_plan.hpp"
#include "render/gl/gl_context.hpp"
#include "render/gl/pass_clock.hpp"
#include "render/gl/shader_library.hpp"
#include "render/mesh/base_color.hpp"
#include "render/mesh/bounds.hpp"
#include "render/mesh/mesh.hpp"
#include "render/object_layers.hpp"
#include "render/passes/camera_blur_pass.hpp"
#include "render/passes/composite_pass.hpp"
#include "render/passes/glare/aperture_glare_pass.hpp"
#include "render/passes/glare/glare_pass.hpp"
#include "render/passes/light_transfer.hpp"
#include "render/passes/object_pass.hpp"
#include "render/passes/receiver_pass.hpp"
#include "render/passes/shadowed_lights.hpp"
#include "render/passes/tone_pass.hpp"
#include "render/probe/light_samples.hpp"
#include "render/scene_check.hpp"
#include "render/split_light.hpp"

namespace catchlight::render {
namespace {

/// How far a smoothed surface may lie from its triangles, in shares of the object's diagonal.
constexpr float kSkinShare = 0.01f;
/// How far above a surface its rays start, in shares of that: ray_start() in shaders/reflection.glsl.
constexpr float kRayStartShare = 0.05f;

int supported_samples(int wanted) {
  GLint limit = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &limit);
  return std::clamp(wanted, 1, static_cast<int>(limit));
}

/// OpenGL draws no textures yet: their colours go to the vertices.
Mesh untextured(Mesh mesh) {
  fold_base_color_textures(mesh);
  return mesh;
}

}  // namespace

struct GlCompositor::Impl {
  Impl(const RenderScene& scene, const CompositorSettings& wanted, std::shared_ptr<ShaderLibrary> compiled);

  Composite render(const FrameView& view, const PlateReader& plate, bool want_layers, bool want_picture);
  SceneNeeds needs() const;
  void relight(const glm::dmat3& tag_from_light);
  void update_view(const FrameView& view, const FramePlan& plan);
  void upload_plate(const PlateReader& plate, const PixelRect& rect);
  void make_targets(const FramePlan& plan);
  bool divides_glare() const;
  void draw_virtual_layer(const FramePlan& plan, Composite& result);
  void draw_object(const FramePlan& plan);
  void draw_receiver(const FramePlan& plan);
  void blur(const FramePlan& plan);
  bool find_highlights(const FramePlan& plan);
  PixelRect spread_glare(const CameraModel& camera);
  void draw_composite(const FrameView& view, const FramePlan& plan, const Composite& result);
  void meter_frame(const FrameView& view, const FramePlan& plan, Composite& result);
  void apply_tone(const FrameView& view, const FramePlan& plan, Composite& result);
  void read_layers(const FramePlan& plan, Layers& layers);

  /// Does a named pass: the name is that of its timer and of its GL debug group.
  template <typename Work>
  void pass(const char* name, const Work& work) {
    const auto scope = clock.pass(name);
    work();
  }

  CompositorSettings settings;
  SplitLight light_probe;  ///< the scene's light in the probe's frame
  glm::vec3 probe_in_tag_m;
  Bounds bounds;
  PassClock clock;
  std::shared_ptr<ShaderLibrary> library;
  ShaderLibrary& shaders;
  LightTransfer light;
  ShadowedLights lights;
  ObjectPass object;
  std::unique_ptr<ReceiverPass> receiver;
  CameraBlur object_blur, shadow_blur, emission_blur, reflection_blur, geometry_blur;
  GlarePass glare;
  std::unique_ptr<ApertureGlarePass> aperture_glare;  ///< takes the place of `glare` where settings.glare.method is fft
  CompositePass composite;
  std::unique_ptr<TonePass> tone;  ///< null: neither a tone curve nor the classic look
  UniformBuffer<shader_interface::ViewUniforms> view_uniforms{"view"};
  std::optional<glm::dmat3> lit_from;  ///< the light's turn that the points are lit for
  std::unique_ptr<ObjectTarget> object_target;
  std::unique_ptr<ColorTarget<1>> shadow_target;
  /// The virtual layer after the camera's blur. Null: not drawn in this frame.
  struct Seen {
    const GlTexture *object, *shadow, *emission, *reflection;
  } seen{};
  std::vector<PassTime> times;
};

GlCompositor::Impl::Impl(const RenderScene& scene, const CompositorSettings& wanted, std::shared_ptr<ShaderLibrary> compiled)
    : settings(wanted),
      light_probe(split_light(checked(scene))),
      probe_in_tag_m(scene.probe_in_tag_m),
      bounds(bounds_of(scene.mesh)),
      library(std::move(compiled)),
      shaders(*library),
      light(shaders),
      lights(static_cast<int>(scene.lights.size()), bounds, shaders),
      object(untextured(scene.mesh),
             LitPoints("object", scene.transfer.object, scene.transfer.object_direct, sh_count(scene.transfer.bands)),
             scene.reflections, scene.rest_reflections, kRayStartShare * kSkinShare * bounds.rounded_diagonal_m(), shaders),
      object_blur(shaders),
      shadow_blur(shaders),
      emission_blur(shaders),
      reflection_blur(shaders),
      geometry_blur(shaders),
      glare(wanted.glare, shaders),
      composite(shaders) {
  settings.samples = supported_samples(wanted.samples);
  if (wanted.tone.enabled || wanted.look == Look::classic) tone = std::make_unique<TonePass>(wanted, shaders);
  if (wanted.look == Look::classic) settings.glare.enabled = false;  // the classic look has its own
  if (settings.glare.enabled && wanted.glare.method == GlareMethod::fft)
    aperture_glare = std::make_unique<ApertureGlarePass>(wanted.glare);
  if (scene.transfer.grid.columns >= 2 && scene.transfer.grid.rows >= 2)
    receiver = std::make_unique<ReceiverPass>(scene.transfer, shaders);
  check_gl("the compositor's start");
}

SceneNeeds GlCompositor::Impl::needs() const {
  SceneNeeds result;
  result.object = bounds;
  if (receiver) result.shadow_reach = receiver->reach();
  result.mirrors = settings.reflection_rays > 0 && object.reflects();
  result.has_glare = settings.glare.enabled;
  result.recodes_frames = tone != nullptr;
  return result;
}

/// The light turns against the object only where the probe is fixed to the camera.
void GlCompositor::Impl::relight(const glm::dmat3& tag_from_light) {
  const SplitLight light_tag = tag_from_light == glm::dmat3(1.0) ? light_probe : turned(light_probe, tag_from_light);
  light.set_light(light_tag.whole, light_tag.split_off);
  lights.update(light_tag.samples, [this] { object.draw_geometry(); });
  object.light_by(light, lights);
  if (receiver) receiver->light_by(light, light_tag, lights, bounds);
  lit_from = tag_from_light;
}

void GlCompositor::Impl::update_view(const FrameView& view, const FramePlan& plan) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = view.camera.distortion;
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
  block.distortion_limit =
      glm::vec4(plan.distortion_limit.radius, plan.distortion_limit.distorted, plan.distortion_limit.slope, 0);
  block.frame = glm::vec4(view.camera.width_px, view.camera.height_px, view.camera.fx_px, 0);
  block.probe_in_tag_m = glm::vec4(probe_in_tag_m, kSkinShare * bounds.rounded_diagonal_m());
  block.options = {settings.reflection_rays, plan.mirrors_receiver ? 1 : 0, 0, 0};
  view_uniforms.update(block);
  view_uniforms.bind(BINDING_VIEW);
}

void GlCompositor::Impl::make_targets(const FramePlan& plan) {
  const int width = roomy(plan.virtual_rect.width), height = roomy(plan.virtual_rect.height);
  if (!object_target || !object_target->fits(width, height, plan.makes_layers)) {
    object_target = std::make_unique<ObjectTarget>(width, height, settings.samples, plan.makes_layers, divides_glare());
  }
  if (!shadow_target || !shadow_target->fits(width, height))
    shadow_target = std::make_unique<ColorTarget<1>>("shadow", GL_RGBA32F, width, height);
}

/// What the object emits glares otherwise than what it reflects.
bool GlCompositor::Impl::divides_glare() const {
  const GlareSettings& g = settings.glare;
  return g.enabled && object.emits() &&
         (g.emitter_strength != 1 || (g.emitter_directions != 0 && g.emitter_directions != g.streak_directions));
}

void GlCompositor::Impl::draw_object(const FramePlan& plan) {
  if (receiver) receiver->bind();
  lights.bind();
  glBindTextureUnit(TEXTURE_PLATE_LIGHT, composite.plate_light().id());
  object.draw(*object_target, plan.virtual_rect, plan.frame.width, plan.frame.height);
}

void GlCompositor::Impl::draw_receiver(const FramePlan& plan) {
  const float no_shadow[4] = {1, 1, 1, 1};
  reset_state();
  glClearNamedFramebufferfv(shadow_target->framebuffer(), GL_COLOR, 0, no_shadow);
  if (plan.draws_receiver) receiver->draw(*shadow_target, plan.virtual_rect, plan.frame.width, plan.frame.height);
}

/// All that is light is blurred as the object is. Normals and depth are too, but kept sharp where the sharp object is.
void GlCompositor::Impl::blur(const FramePlan& plan) {
  const auto apply = [&](CameraBlur& blur, const MotionField& motion, const GlTexture*& texture) {
    if (texture) texture = &blur.apply(plan.blur, motion, *texture, plan.virtual_rect);
  };
  apply(object_blur, plan.blur.object, seen.object);
  apply(shadow_blur, plan.blur.shadow, seen.shadow);
  apply(emission_blur, plan.blur.object, seen.emission);
  apply(reflection_blur, plan.blur.object, seen.reflection);
  if (plan.makes_layers) geometry_blur.apply(plan.blur, plan.blur.object, object_target->normal_depth(), plan.virtual_rect);
}

bool GlCompositor::Impl::find_highlights(const FramePlan& plan) {
  const PixelRect& rect = plan.virtual_rect;
  if (aperture_glare) return aperture_glare->extract(*seen.object, rect, plan.frame.width, plan.frame.height);
  return glare.extract(*seen.object, seen.emission, rect, plan.frame.width, plan.frame.height);
}

PixelRect GlCompositor::Impl::spread_glare(const CameraModel& camera) {
  return aperture_glare ? aperture_glare->spread(camera) : glare.spread();
}

/// Draws object and shadow, blurs them as the camera does, and looks for highlights that glare.
void GlCompositor::Impl::draw_virtual_layer(const FramePlan& plan, Composite& result) {
  make_targets(plan);
  pass("object", [&] { draw_object(plan); });
  pass("receiver", [&] { draw_receiver(plan); });
  seen = {&object_target->color(), &shadow_target->texture(), divides_glare() ? &object_target->emission() : nullptr,
          plan.makes_layers ? &object_target->reflection() : nullptr};
  if (!plan.blur.empty()) pass("lens blur", [&] { blur(plan); });
  if (plan.seeks_glare) pass("highlights", [&] { result.glare_drawn = find_highlights(plan); });
}

void GlCompositor::Impl::upload_plate(const PlateReader& plate, const PixelRect& rect) {
  const Plate result = plate(rect);
  if (result.rect != rect) throw Error("the plate reader gave another rectangle than it was asked for");
  composite.upload(result);
}

void GlCompositor::Impl::draw_composite(const FrameView& view, const FramePlan& plan, const Composite& result) {
  VirtualLayer layer{plan.virtual_rect, seen.object, seen.shadow, nullptr, seen.reflection};
  layer.passed_at_tag = plan.passed_at_tag;
  if (result.glare_drawn) layer.glare = &glare;
  if (result.glare_drawn && aperture_glare) layer.pixel_glare = &aperture_glare->glare();
  composite.draw(view, result.rect, layer, plan.makes_layers, plan.is_toned);
}

void GlCompositor::Impl::meter_frame(const FrameView& view, const FramePlan& plan, Composite& result) {
  result.tone_wanted = tone->meter(composite.drawn(), plan.frame.width, plan.frame.height, view.color);
}

/// The whole frame, drawn as linear light, becomes codes.
void GlCompositor::Impl::apply_tone(const FrameView& view, const FramePlan& plan, Composite& result) {
  const int width = plan.frame.width, height = plan.frame.height;
  tone->draw_glare(composite.drawn(), width, height);
  tone->draw(composite.drawn(), width, height, view.color, view.tone.value_or(result.tone_wanted));
  result.rgba = tone->read();
}

void GlCompositor::Impl::read_layers(const FramePlan& plan, Layers& layers) {
  layers = empty_layers(plan.frame);
  composite.read_layers(layers);
  if (!plan.draws_virtual()) return;
  const PixelRect& rect = plan.virtual_rect;
  const Image color = object_target->read(0, rect.width, rect.height);
  add_geometry(color, object_target->read(2, rect.width, rect.height), rect, layers);
  if (plan.blur.empty()) return;
  add_geometry(object_blur.read(rect.width, rect.height), geometry_blur.read(rect.width, rect.height), rect, layers);
}

Composite GlCompositor::Impl::render(const FrameView& view, const PlateReader& plate, bool want_layers, bool want_picture) {
  check_view(view);
  clock.begin_frame();
  times.clear();
  if (view.has_pose && lit_from != view.tag_from_light) pass("light", [&] { relight(view.tag_from_light); });
  const FramePlan plan = plan_frame(view, needs(), want_layers);
  Composite result;
  if (plan.empty()) return result;
  if (plan.draws_virtual()) update_view(view, plan);
  if (plan.mirrors_receiver) {
    pass("plate", [&] { upload_plate(plate, plan.frame); });
    pass("plate light", [&] { composite.draw_plate_light(view); });
  }
  if (plan.draws_virtual()) draw_virtual_layer(plan, result);
  if (result.glare_drawn) pass("glare", [&] { result.glare_rect = spread_glare(view.camera); });
  result.rect = plan.output_rect(plan.virtual_rect, result.glare_rect);
  if (!plan.mirrors_receiver) pass("plate", [&] { upload_plate(plate, result.rect); });
  pass("composite", [&] { draw_composite(view, plan, result); });
  if (plan.is_toned) {
    pass("meter", [&] { meter_frame(view, plan, result); });
    if (want_picture) pass("tone", [&] { apply_tone(view, plan, result); });
  } else {
    result.rgba = composite.read();
  }
  if (plan.makes_layers) read_layers(plan, result.layers.emplace());
  check_gl("a frame");
  times = clock.times();
  return result;
}

GlCompositor::GlCompositor(const RenderScene& scene, const CompositorSettings& settings, std::shared_ptr<ShaderLibrary> shaders)
    : impl_(std::make_unique<Impl>(scene, settings,
                                   shaders ? std::move(shaders) : std::make_shared<ShaderLibrary>(settings.shader_folder))) {}
GlCompositor::~GlCompositor() = default;
GlCompositor::GlCompositor(GlCompositor&&) noexcept = default;
GlCompositor& GlCompositor::operator=(GlCompositor&&) noexcept = default;

Composite GlCompositor::render(const FrameView& view, const PlateReader& plate, bool want_layers, const CompositeSink&) {
  return impl_->render(view, plate, want_layers, true);
}

ToneCurve GlCompositor::meter(const FrameView& view, const PlateReader& plate) {
  return impl_->render(view, plate, false, false).tone_wanted;
}

const std::vector<PassTime>& GlCompositor::pass_times() const {
  return impl_->times;
}

std::vector<std::string> GlCompositor::reload_shaders() {
  impl_->lit_from.reset();  // what is drawn once and kept is drawn with the new programs too
  return impl_->shaders.reload();
}

}  // namespace catchlight::render
