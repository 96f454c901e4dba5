#include "app/session/stage.hpp"

#include "app/session/frame_view.hpp"
#include "app/settings/look.hpp"
#include "app/settings/parameters.hpp"
#include "app/support/progress.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "render/settings.hpp"

namespace catchlight::app {
namespace {

render::FrameView frame_view(const CameraModel& camera, const SceneSettings& scene, const BuiltScene& built, const TrackRow& row,
                             const Frame& frame) {
  render::FrameView view;
  view.camera = scene.lens.as_drawn(camera);
  view.color = frame.color();
  view.has_pose = row.found;
  if (!row.found) return view;
  view.camera_from_tag = row.camera_from_tag;
  const LayerExposure exposure = layer_exposure(scene.exposure, row, tag_irradiance_over_pi(built, row.camera_from_tag));
  view.exposure = exposure.gain;
  view.black = exposure.black;
  if (row.has_exposure) view.receiver_light = row.exposure * scene.receiver.albedo + row.black;
  view.tag_from_light = tag_from_light(built, row.camera_from_tag);
  view.lens = lens_view(scene.lens, row, frame);
  return view;
}

PlateReader reader(const Frame& frame) {
  return [&frame](const PixelRect& rect) { return frame.rgb(rect); };
}

}  // namespace

Stage build_stage(const SceneSettings& scene, Log& log, Report& report) {
  Stage stage;
  stage.context = render::make_headless_context();
  report.renderer = render::gl_info().renderer;
  stage.built = build_render_scene(scene, log.warning_handler(), progress_handler(log, "bake"));
  report.plan = stage.built.plan;
  render::CompositorSettings settings;
  settings.glare = scene.glare;
  settings.glare.aperture = word_or_path(scene, "glare.aperture");
  settings.look = scene.look;
  settings.tone = tone_settings(scene);
  settings.samples = scene.quality.samples;
  settings.reflection_rays = scene.quality.reflection_rays;
  settings.shader_folder = scene.shader_folder;
  stage.compositor = std::make_unique<render::Compositor>(stage.built.scene, settings);
  return stage;
}

FrameDrawing::FrameDrawing(Stage& stage, const SceneSettings& scene, const CameraModel& camera, bool want_layers)
    : stage_(stage),
      scene_(scene),
      camera_(camera),
      want_layers_(want_layers),
      adaptation_(scene.exposure.adapt_bright_s, scene.exposure.adapt_dark_s) {}

Composite FrameDrawing::draw(const Frame& frame, const TrackRow& row) {
  pass_times_.clear();
  if (!row.found && !(recodes_every_frame(scene_) && !want_layers_)) return {};
  const render::FrameView view = view_of(frame, row);
  Composite composite = stage_.compositor->render(view, reader(frame), want_layers_);
  pass_times_ = stage_.compositor->pass_times();
  if (adapts()) adaptation_.see(frame.time_s(), composite.tone_wanted);
  return composite;
}

void FrameDrawing::pass_over(const Frame& frame, const TrackRow& row) {
  if (adapts()) adaptation_.see(frame.time_s(), stage_.compositor->meter(view_of(frame, row), reader(frame)));
}

bool FrameDrawing::adapts() const {
  return tone_settings(scene_).enabled && !want_layers_;
}

render::FrameView FrameDrawing::view_of(const Frame& frame, const TrackRow& row) const {
  render::FrameView view = frame_view(camera_, scene_, stage_.built, row, frame);
  view.tone = adapts() ? adaptation_.at(frame.time_s()) : std::nullopt;
  return view;
}

}  // namespace catchlight::app
