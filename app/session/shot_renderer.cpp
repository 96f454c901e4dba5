#include "app/session/shot_renderer.hpp"

#include "app/media/pixels/full_color.hpp"
#include "app/media/pixels/untouched_layers.hpp"
#include "app/session/frame_view.hpp"
#include "app/settings/change_cost.hpp"
#include "app/settings/look.hpp"
#include "app/settings/parameters.hpp"
#include "app/support/progress.hpp"
#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/file_stamp.hpp"
#include "render/cpu/cpu_compositor.hpp"
#include "render/gl_compositor.hpp"
#include "render/glare/aperture_picture.hpp"
#include "render/light_shares.hpp"
#include "render/surface_material.hpp"

namespace catchlight::app {
namespace {

PlateReader reader(const Frame& frame) {
  return [&frame](const PixelRect& rect) { return frame.rgb(rect); };
}

/// The context to draw with; null where the processor is to draw.
std::unique_ptr<render::GlContext> context_for(const SceneSettings& scene) {
  if (scene.renderer == Renderer::cpu) return nullptr;
  if (scene.renderer != Renderer::gl && scene.shader_folder.empty()) return render::make_hardware_context();
  try {
    return render::make_headless_context();
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + "\nThe processor draws without OpenGL: leave --renderer and --shader-dir out");
  }
}

}  // namespace

render::CompositorSettings compositor_settings(const SceneSettings& scene) {
  render::CompositorSettings settings;
  settings.glare = scene.glare;
  settings.glare.aperture = word_or_path(scene, "glare.aperture");
  settings.look = scene.look;
  settings.tone = tone_settings(scene);
  settings.samples = scene.quality.samples;
  settings.reflection_rays = scene.quality.reflection_rays;
  settings.shader_folder = scene.shader_folder;
  return settings;
}

ShotRenderer::ShotRenderer(SceneSettings settings, const CameraModel& camera, Wanted wanted, Log& log)
    : settings_(std::move(settings)),
      camera_(camera),
      wanted_(wanted),
      log_(log),
      adaptation_(settings_.exposure.adapt_bright_s, settings_.exposure.adapt_dark_s) {}

ShotRenderer::~ShotRenderer() {
  if (context_) context_->make_current();
}

void ShotRenderer::apply(const SceneSettings& settings, BakeFineness fineness) {
  const SceneSettings::Exposure &before = settings_.exposure, &after = settings.exposure;
  if (!costs_of_change(settings_, settings).empty()) metered_.clear();
  const bool adapts_otherwise = before.adapt_bright_s != after.adapt_bright_s || before.adapt_dark_s != after.adapt_dark_s;
  settings_ = settings;
  fineness_ = fineness;
  is_loaded_ = is_built_ = false;
  if (adapts_otherwise) restart();
}

const BuiltScene& ShotRenderer::load() {
  if (!is_loaded_) builder_.load(settings_, log_.warning_handler());
  is_loaded_ = true;
  return builder_.scene();
}

void ShotRenderer::check_aperture() const {
  const std::string aperture = word_or_path(settings_, "glare.aperture");
  if (aperture != "none") render::aperture_picture(aperture);
}

void ShotRenderer::open_renderer() {
  if (context_) return context_->make_current();
  if (!renderer_name_.empty()) return;
  context_ = context_for(settings_);
  if (context_) shaders_ = std::make_shared<render::ShaderLibrary>(settings_.shader_folder);
  renderer_name_ = context_ ? render::gl_info().renderer : "cpu";
}

void ShotRenderer::restart() {
  adaptation_ = render::ToneAdaptation(settings_.exposure.adapt_bright_s, settings_.exposure.adapt_dark_s);
}

std::unique_ptr<render::Compositor> ShotRenderer::make_compositor(const render::RenderScene& scene,
                                                                  const render::CompositorSettings& settings) const {
  if (context_ && scene.mesh.has_textures())
    log_.warn("OpenGL draws base colour textures only, as finely as the mesh is cut; --renderer cpu draws all per pixel");
  if (context_) return std::make_unique<render::GlCompositor>(scene, settings, shaders_);
  return std::make_unique<render::CpuCompositor>(scene, settings);
}

void ShotRenderer::prepare() {
  open_renderer();
  if (is_built_) return;
  const BuiltScene& built = builder_.build(settings_, log_.warning_handler(), progress_handler(log_, "bake"), fineness_);
  const render::CompositorSettings wanted = compositor_settings(settings_);
  const std::string aperture = file_stamp(wanted.glare.aperture);
  if (!compositor_ || drawn_version_ != built.version || drawn_settings_ != wanted || drawn_aperture_ != aperture) {
    compositor_.reset();
    compositor_ = make_compositor(built.scene, wanted);
    drawn_version_ = built.version;
    drawn_settings_ = wanted;
    drawn_aperture_ = aperture;
  }
  is_loaded_ = is_built_ = true;
}

std::vector<std::string> ShotRenderer::reload_shaders() {
  auto* drawn_by = dynamic_cast<render::GlCompositor*>(compositor_.get());
  if (!drawn_by) return {};
  context_->make_current();
  lone_light_.compositor.reset();
  return drawn_by->reload_shaders();
}

void ShotRenderer::view(FrameJob& job) {
  job.view = frame_view(job.image, job.track, camera_, settings_, load());
  if (fineness_ == BakeFineness::rough) job.view.light_turns = true;  // under a hand, it does
  if (adapts()) job.view.tone = adaptation_.at(job.image.time_s());
}

void ShotRenderer::render(FrameJob& job) {
  pass_times_.clear();
  job.result = {};
  if (job.track.found || (recodes_every_frame(settings_) && !wanted_.layers)) {
    prepare();
    view(job);
    draw(job);
    pass_times_ = compositor_->pass_times();
    if (adapts()) adaptation_.see(job.image.time_s(), job.result.tone_wanted);
  }
  if (settings_.lens.chroma_subsampling == Switch::off) job.image = with_full_color(job.image);
}

void ShotRenderer::draw(FrameJob& job) {
  const bool keeps_subsampling = settings_.lens.chroma_subsampling != Switch::off;
  std::optional<FrameWriter> writer;
  if (wanted_.frames && !wanted_.layers && keeps_subsampling) writer.emplace(job.image);
  CompositeSink take;
  if (writer) take = [&](const Composite& band) { writer->write(band); };
  job.result = compositor_->render(job.view, reader(job.image), wanted_.layers, take);
  const bool is_taken = job.result.rgba.empty() && !job.result.rect.empty();
  if (writer && is_taken) job.image = std::move(*writer).finish();
}

Layers ShotRenderer::layers(const FrameJob& job) {
  if (!job.track.found) return untouched_layers(job.image);
  prepare();
  return *compositor_->render(job.view, reader(job.image), true).layers;
}

std::span<const render::LightSample> ShotRenderer::samples_of(std::optional<std::size_t> light) const {
  const std::span<const render::LightSample> all = builder_.scene().scene.lights;
  const std::vector<render::LightSummary>& lights = builder_.lights();
  if (!light) return all;
  if (*light >= lights.size()) return {};
  std::size_t first = 0;
  for (std::size_t i = 0; i < *light; ++i) first += lights[i].samples;
  return all.subspan(first, lights[*light].samples);
}

/// `light` empty: all of them together.
render::Compositor& ShotRenderer::compositor_of_light(std::optional<std::size_t> light) {
  const render::CompositorSettings settings = render::settings_alone(compositor_settings(settings_));
  LoneLight& lone = lone_light_;
  if (!lone.compositor || lone.light != light || lone.drawn_version != drawn_version_ || lone.settings != settings) {
    lone.compositor.reset();
    lone.compositor = make_compositor(render::lit_alone(builder_.scene().scene, samples_of(light)), settings);
    lone.light = light, lone.drawn_version = drawn_version_, lone.settings = settings;
  }
  return *lone.compositor;
}

Image ShotRenderer::light_share(const FrameJob& job, std::optional<std::size_t> light) {
  const auto whole = [&] { return render::light_of(layers(job), glm::dvec3(1.0)); };
  const std::span<const render::LightSample> samples = samples_of(light);
  if (!job.track.found || samples.empty()) return light ? Image(job.image.width_px(), job.image.height_px()) : whole();
  prepare();
  const glm::dvec3 on_plane = render::plane_share(builder_.scene().scene, samples, job.view.tag_from_light);
  const Composite lone = compositor_of_light(light).render(render::view_alone(job.view), reader(job.image), true);
  Image lit = render::light_of(*lone.layers, on_plane);
  if (light) return lit;
  Image rest = whole();
  for (std::size_t i = 0; i < rest.data.size(); ++i) rest.data[i] -= lit.data[i];
  return rest;
}

std::vector<double> ShotRenderer::plane_shares(const FrameJob& job) const {
  std::vector<double> shares;
  for (std::size_t light = 0; light < builder_.lights().size(); ++light)
    shares.push_back(
        glm::dot(kLuminanceWeights, render::plane_share(builder_.scene().scene, samples_of(light), job.view.tag_from_light)));
  return shares;
}

void ShotRenderer::skip(FrameJob& job) {
  if (!adapts()) return;
  prepare();
  view(job);
  adaptation_.see(job.image.time_s(), compositor_->meter(job.view, reader(job.image)));
}

void ShotRenderer::adapt_until(std::size_t position, const std::function<std::optional<FrameJob>(std::size_t)>& tracked) {
  prepare();
  if (std::exchange(metered_version_, drawn_version_) != drawn_version_) metered_.clear();
  while (metered_.size() < position) {
    std::optional<FrameJob> job = tracked(metered_.size());
    if (!job) break;
    job->view = frame_view(job->image, job->track, camera_, settings_, load());
    metered_.push_back({job->image.time_s(), compositor_->meter(job->view, reader(job->image))});
  }
  restart();
  for (std::size_t i = 0; i < std::min(position, metered_.size()); ++i) adaptation_.see(metered_[i].time_s, metered_[i].wanted);
}

PlanEntry ShotRenderer::renderer_entry() const {
  if (settings_.renderer != Renderer::automatic) return {"renderer", renderer_name_, "set by hand"};
  if (!settings_.shader_folder.empty()) return {"renderer", renderer_name_, "--shader-dir has shaders for OpenGL"};
  return {"renderer", renderer_name_, context_ ? "there is a graphics card" : "OpenGL is missing, or has no graphics card"};
}

PlanEntry ShotRenderer::reflection_entry() const {
  const int rays = settings_.quality.reflection_rays;
  if (!render::surface_materials(builder_.scene().scene.mesh).reflects)
    return {"reflection rays", "none", "nothing of the object mirrors"};
  if (rays == 0) return {"reflection rays", "none", "quality.reflection_rays is 0: the probe alone is mirrored"};
  const std::string value = std::to_string(rays) + " over a rough lobe, 4 over a polished one";
  if (context_) return {"reflection rays", value, "in each pixel that may mirror the object"};
  return {"reflection rays", value,
          "2 to 8 neighbours with much the same lobe share them; traced where the object may be mirrored"};
}

std::vector<PlanEntry> ShotRenderer::plan() const {
  std::vector<PlanEntry> plan = builder_.scene().plan;
  if (plan.empty()) return plan;
  plan.insert(plan.begin(), renderer_entry());
  plan.push_back(reflection_entry());
  return plan;
}

bool ShotRenderer::adapts() const {
  return tone_settings(settings_).enabled && !wanted_.layers;
}

}  // namespace catchlight::app
