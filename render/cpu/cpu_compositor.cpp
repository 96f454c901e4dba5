#include "render/cpu/cpu_compositor.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "catchlight/error.hpp"
#include "render/cpu/cpu_object.hpp"
#include "render/cpu/glare/make_cpu_glare.hpp"
#include "render/cpu/pass_stopwatch.hpp"
#include "render/cpu/plate/layer_blur.hpp"
#include "render/cpu/plate/plate_composite.hpp"
#include "render/cpu/receiver/receiver_image.hpp"
#include "render/cpu/tone/cpu_tone.hpp"
#include "render/object_layers.hpp"
#include "render/scene_check.hpp"
#include "render/split_light.hpp"

namespace catchlight::render {

struct CpuCompositor::Impl {
  Impl(const RenderScene& given, const CompositorSettings& wanted);

  Composite render(const FrameView& view, const PlateReader& plate, bool want_layers, bool want_picture,
                   const CompositeSink& take);
  SceneNeeds needs() const;
  void relight(const FrameView& view);
  bool divides_glare() const;
  void read_plate(const FrameView& view, const PlateReader& plate, const PixelRect& rect);
  void make_images(const FrameView& view, const FramePlan& plan);
  void draw_virtual_layer(const FrameView& view, const FramePlan& plan, Composite& result);
  void blur(const FramePlan& plan);
  void draw_composite(const FrameView& view, const FramePlan& plan, const CompositeSink& take, Composite& result);
  void apply_tone(const FrameView& view, const FramePlan& plan, bool want_picture, Composite& result);

  RenderScene scene;
  CompositorSettings settings;
  SplitLight light_probe;  ///< the scene's light in the probe's frame
  Bounds bounds;
  RayScene rays;
  CpuObject object;
  std::optional<ReceiverShadow> receiver;
  std::unique_ptr<CpuGlare> glare;
  std::optional<CpuTone> tone;         ///< none: neither a tone curve nor the classic look
  std::optional<glm::dmat3> lit_from;  ///< the light's turn that all is lit for
  bool lit_in_passing = false;         ///< for a light that turns with every frame
  PixelRays pixel_rays;
  ResponseTable response;
  Plate plate;
  PlateLight plate_light;
  ObjectImages images;
  ReceiverImage shadow;
  LayerBlur layer_blur;
  PassStopwatch clock;
};

CpuCompositor::Impl::Impl(const RenderScene& given, const CompositorSettings& wanted)
    : scene(checked(given)),
      settings(wanted),
      light_probe(split_light(scene)),
      bounds(bounds_of(scene.mesh)),
      rays(scene.mesh),
      object(scene, rays, bounds, std::clamp(wanted.samples, 1, 16), wanted.reflection_rays) {
  if (wanted.tone.enabled || wanted.look == Look::classic) tone.emplace(wanted);
  if (wanted.look == Look::classic) settings.glare.enabled = false;  // the classic look has its own
  if (settings.glare.enabled) glare = make_cpu_glare(settings.glare);
  if (scene.transfer.grid.columns >= 2 && scene.transfer.grid.rows >= 2) receiver.emplace(scene.transfer, rays, bounds);
}

SceneNeeds CpuCompositor::Impl::needs() const {
  SceneNeeds result;
  result.object = bounds;
  if (receiver) result.shadow_reach = receiver->reach();
  result.mirrors = settings.reflection_rays > 0 && object.reflects();
  result.has_glare = settings.glare.enabled;
  result.recodes_frames = tone.has_value();
  return result;
}

void CpuCompositor::Impl::relight(const FrameView& view) {
  const bool stands_still = !view.light_turns, is_turned = view.tag_from_light != glm::dmat3(1.0);
  const SplitLight light_tag = is_turned ? turned(light_probe, view.tag_from_light) : light_probe;
  KeyedCache kept;
  if (stands_still && !scene.transfer_key.empty()) kept = {ContentCache(""), content_hash(scene.transfer_key, light_tag)};
  object.light_by(light_tag, stands_still, kept);
  if (receiver) receiver->update(light_tag, stands_still, kept);
  lit_from = view.tag_from_light;
  lit_in_passing = view.light_turns;
}

/// What the object emits glares otherwise than what it reflects.
bool CpuCompositor::Impl::divides_glare() const {
  const GlareSettings& g = settings.glare;
  return g.enabled && object.emits() &&
         (g.emitter_strength != 1 || (g.emitter_directions != 0 && g.emitter_directions != g.streak_directions));
}

void CpuCompositor::Impl::read_plate(const FrameView& view, const PlateReader& reader, const PixelRect& rect) {
  plate = reader(rect);
  if (plate.rect != rect) throw Error("the plate reader gave another rectangle than it was asked for");
  check_plate(plate);
  response.set(view.color, plate.format);
}

void CpuCompositor::Impl::make_images(const FrameView& view, const FramePlan& plan) {
  images.covered = object.covered(view, plan);
  images.rect = intersect(grown(images.covered, plan.blur.reach_px(images.covered)), plan.virtual_rect);
  const auto clear = [&](Image& image, bool is_wanted) {
    image.width = images.rect.width, image.height = images.rect.height, image.channels = 4;
    image.data.assign(is_wanted ? static_cast<std::size_t>(image.width) * image.height * 4 : 0, 0.0f);
  };
  clear(images.color, true);
  clear(images.reflection, plan.makes_layers);
  clear(images.normal_depth, plan.makes_layers);
  clear(images.emission, divides_glare());
}

/// All that is light is blurred as the object is. Normals and depth are too, but kept sharp where the sharp object is.
void CpuCompositor::Impl::blur(const FramePlan& plan) {
  const auto blur_one = [&](Image& image, const PixelRect& rect, std::span<const PixelRect> active, const MotionField& motion,
                            double invisible) {
    if (active.empty()) return;
    int reach = 0;
    if (plan.blur.variance_px2 > 0) {
      const std::vector<float> weights = discrete_gaussian(plan.blur.variance_px2, invisible);
      layer_blur.defocus(image, active, weights);
      reach = static_cast<int>(weights.size());
    }
    if (!plan.blur.moves) return;
    PixelRect all;
    for (const PixelRect& band : active) all = unite(all, band);
    layer_blur.move(image, grown(all, reach), motion, glm::dvec2(rect.x, rect.y));
  };
  // Highlights are far brighter than what lies around them; a shadow's ratio never is.
  PixelRect covered = images.covered;
  covered.x -= images.rect.x, covered.y -= images.rect.y;
  for (Image* image : {&images.color, &images.reflection, &images.normal_depth, &images.emission})
    if (!covered.empty() && !image->data.empty()) blur_one(*image, images.rect, {&covered, 1}, plan.blur.object, 1e-5);
  blur_one(shadow.pixels(), shadow.rect(), shadow.sharp(), plan.blur.shadow, 2e-3);
}

/// Draws object and shadow, blurs them as the camera does, and looks for highlights that glare.
void CpuCompositor::Impl::draw_virtual_layer(const FrameView& view, const FramePlan& plan, Composite& result) {
  pixel_rays.set_camera(view.camera, plan.distortion_limit);
  make_images(view, plan);
  const bool mirrors_plate = plan.mirrors_receiver;
  clock.pass("object", [&] {
    object.draw(view, plan, pixel_rays, mirrors_plate ? &*receiver : nullptr, mirrors_plate ? &plate_light : nullptr, images);
  });
  clock.pass("receiver", [&] {
    if (receiver)
      shadow.draw(view, plan, pixel_rays, *receiver);
    else
      shadow.clear();
  });
  if (result.layers) add_geometry(images.color, images.normal_depth, images.rect, *result.layers);
  if (!plan.blur.empty()) {
    clock.pass("lens blur", [&] { blur(plan); });
    if (result.layers) add_geometry(images.color, images.normal_depth, images.rect, *result.layers);
  }
  if (plan.seeks_glare && glare)
    clock.pass("highlights", [&] {
      const Image* emission = divides_glare() ? &images.emission : nullptr;
      result.glare_drawn = glare->extract(images.color, emission, images.rect, plan.frame.width, plan.frame.height);
    });
}

void CpuCompositor::Impl::draw_composite(const FrameView& view, const FramePlan& plan, const CompositeSink& take,
                                         Composite& result) {
  VirtualImages images_in_frame;
  if (plan.draws_virtual()) {
    images_in_frame.object = &images.color, images_in_frame.reflection = &images.reflection;
    images_in_frame.object_rect = images.rect;
    images_in_frame.shadow = [&](int x, int y, int count, const std::array<float*, 3>& ratio) {
      return shadow.read_row(x, y, count, ratio);
    };
  }
  images_in_frame.passed_at_tag = plan.passed_at_tag;
  if (result.glare_drawn)
    images_in_frame.glare = [this](int x, int y, int count, float* rgb) { glare->read_row(x, y, count, rgb); };
  const Plate& whole = plan.mirrors_receiver ? plate_light.plate() : plate;
  const bool is_whole = plan.is_toned || plan.makes_layers || !take;
  composite_plate(view, whole, response, images_in_frame, plan.is_toned, is_whole ? CompositeSink{} : take, result);
}

/// The whole frame, composited as linear light, becomes codes.
void CpuCompositor::Impl::apply_tone(const FrameView& view, const FramePlan& plan, bool want_picture, Composite& result) {
  Image light;
  light.width = plan.frame.width, light.height = plan.frame.height, light.channels = 4;
  light.data = std::move(result.rgba);
  clock.pass("meter", [&] { result.tone_wanted = tone->meter(light, view.color); });
  if (want_picture)
    clock.pass("tone", [&] {
      const bool codes_end_at_1 = plate.format != Plate::Format::rgb_f32;
      tone->apply(light, view.color, view.tone.value_or(result.tone_wanted), codes_end_at_1);
    });
  result.rgba = std::move(light.data);
}

Composite CpuCompositor::Impl::render(const FrameView& view, const PlateReader& reader, bool want_layers, bool want_picture,
                                      const CompositeSink& take) {
  check_view(view);
  clock.begin_frame();
  const bool is_lit = lit_from == view.tag_from_light && lit_in_passing == view.light_turns;
  if (view.has_pose && !is_lit) clock.pass("light", [&] { relight(view); });
  const FramePlan plan = plan_frame(view, needs(), want_layers);
  Composite result;
  if (plan.empty()) return result;
  if (plan.makes_layers) result.layers = empty_layers(plan.frame);
  if (plan.mirrors_receiver) {
    clock.pass("plate", [&] { read_plate(view, reader, plan.frame); });
    clock.pass("plate light", [&] { plate_light.set(std::move(plate), view, response); });
  }
  if (plan.draws_virtual()) draw_virtual_layer(view, plan, result);
  if (result.glare_drawn) clock.pass("glare", [&] { result.glare_rect = glare->spread(view.camera); });
  const PixelRect drawn = plan.draws_virtual() ? unite(images.rect, shadow.shadowed()) : PixelRect{};
  result.rect = plan.output_rect(drawn, result.glare_rect);
  if (result.rect.empty()) return result;
  if (!plan.mirrors_receiver) clock.pass("plate", [&] { read_plate(view, reader, result.rect); });
  clock.pass("composite", [&] { draw_composite(view, plan, take, result); });
  if (plan.is_toned) apply_tone(view, plan, want_picture, result);
  result.plate = std::make_shared<const Plate>(plan.mirrors_receiver ? plate_light.take_plate() : std::move(plate));
  return result;
}

CpuCompositor::CpuCompositor(const RenderScene& scene, const CompositorSettings& settings)
    : impl_(std::make_unique<Impl>(scene, settings)) {}
CpuCompositor::~CpuCompositor() = default;

Composite CpuCompositor::render(const FrameView& view, const PlateReader& plate, bool want_layers, const CompositeSink& take) {
  return impl_->render(view, plate, want_layers, true, take);
}

ToneCurve CpuCompositor::meter(const FrameView& view, const PlateReader& plate) {
  return impl_->render(view, plate, false, false, {}).tone_wanted;
}

const std::vector<PassTime>& CpuCompositor::pass_times() const {
  return impl_->clock.times();
}

}  // namespace catchlight::render
