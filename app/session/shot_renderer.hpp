// Draws a shot's frames: the scene, the compositor and the exposure that adapts from frame to frame.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/session/frame_job.hpp"
#include "app/session/scene_builder.hpp"
#include "app/support/log.hpp"
#include "catchlight/camera.hpp"
#include "render/compositor.hpp"
#include "render/gl/gl_context.hpp"
#include "render/gl/shader_library.hpp"
#include "render/tone/tone_adaptation.hpp"

namespace catchlight::app {

/// Everything is made when it is first needed, and made anew where settings ask for it. Throws as the scene's files, a GL that is
/// asked for and missing, and the compositor do.
class ShotRenderer {
 public:
  struct Wanted {
    bool layers;  ///< for compositing packages: they hold the scene's light and have no tone curve
    bool frames;  ///< composites are written into the frames where that is quicker
  };
  ShotRenderer(SceneSettings settings, const CameraModel& camera, Wanted wanted, Log& log);
  ~ShotRenderer();
  ShotRenderer(const ShotRenderer&) = delete;
  ShotRenderer& operator=(const ShotRenderer&) = delete;

  /// Takes settings for the frames to come.
  void apply(const SceneSettings& settings, BakeFineness fineness = BakeFineness::full);

  /// Reads the scene's files, which view() needs. Quick, so that what is missing is found early.
  const BuiltScene& load();

  /// Chooses what draws, if that is not done yet. Where that is OpenGL, makes the context, or makes it current.
  void open_renderer();

  /// Throws Error where glare.aperture names no picture: it is drawn by long after it could be told.
  void check_aperture() const;

  /// The footage starts again: the exposure has adapted to nothing yet.
  void restart();

  /// Makes the GL context, if one is used, the bake and the compositor: all that takes time before the first frame. Several
  /// renderers may live side by side: each makes its context current before it draws.
  void prepare();

  /// Compiles anew what was edited in the folder of --shader-dir. A shader that does not compile stays as it was; returns what is
  /// wrong with those, by file and line.
  std::vector<std::string> reload_shaders();

  /// Sets job.view from job.image and job.track.
  void view(FrameJob& job);

  /// Sets job.view and job.result; a result without pixels was written into job.image.
  void render(FrameJob& job);

  /// The layers of a frame that render() drew, by its job.view: of one without a pose, empty ones over the plate. `job.image` is
  /// the footage's own.
  Layers layers(const FrameJob& job);

  /// The light that one of the probe's lights adds to a frame that render() drew, of the brightest first: exposed linear RGB of
  /// the whole frame, without glare. `light` empty: all that the other shares leave, which is the environment's, with what is
  /// mirrored of the lights and what materials emit. All shares together are the frame.
  Image light_share(const FrameJob& job, std::optional<std::size_t> light);

  /// The shares of the lights, brightest first, in the light on the receiver: of its luminance.
  std::vector<double> plane_shares(const FrameJob& job) const;

  /// The exposure adapts to frames that are not drawn, too: it must see every frame of the footage, in order.
  void skip(FrameJob& job);

  /// Whether a frame's exposure depends on the frames before it.
  bool adapts() const;

  /// The exposure adapts as it would from the footage's beginning up to a frame at this position. `tracked(i)` is asked for the
  /// frame at position i, in order: what a frame calls for is kept, as long as the scene stays.
  void adapt_until(std::size_t position, const std::function<std::optional<FrameJob>(std::size_t)>& tracked);

  /// The times of the last render()'s passes; empty where nothing was drawn.
  const std::vector<render::PassTime>& pass_times() const { return pass_times_; }

  /// What was chosen for the scene, and for what draws it; empty before prepare().
  std::vector<PlanEntry> plan() const;
  const SceneBuilder& builder() const { return builder_; }

  /// What draws: GL_RENDERER, or "cpu"; empty before open_renderer().
  const std::string& renderer_name() const { return renderer_name_; }

 private:
  PlanEntry renderer_entry() const;
  PlanEntry reflection_entry() const;
  void draw(FrameJob& job);
  std::unique_ptr<render::Compositor> make_compositor(const render::RenderScene& scene,
                                                      const render::CompositorSettings& settings) const;
  std::span<const render::LightSample> samples_of(std::optional<std::size_t> light) const;
  render::Compositor& compositor_of_light(std::optional<std::size_t> light);

  SceneSettings settings_;
  CameraModel camera_;
  Wanted wanted_;
  Log& log_;
  std::unique_ptr<render::GlContext> context_;      ///< outlives the compositor; null where the processor draws
  std::shared_ptr<render::ShaderLibrary> shaders_;  ///< outlives compositors; null where the processor draws
  std::string renderer_name_;
  SceneBuilder builder_;
  BakeFineness fineness_ = BakeFineness::full;
  bool is_loaded_ = false, is_built_ = false;  ///< with these settings
  int drawn_version_ = 0;
  std::optional<render::CompositorSettings> drawn_settings_;  ///< the compositor's
  std::string drawn_aperture_;                                ///< the aperture's file as it was read
  std::unique_ptr<render::Compositor> compositor_;
  /// Draws what some of the lights add; made where that is asked for.
  struct LoneLight {
    std::optional<std::size_t> light;
    int drawn_version = 0;
    render::CompositorSettings settings;
    std::unique_ptr<render::Compositor> compositor;
  };
  LoneLight lone_light_;
  render::ToneAdaptation adaptation_;
  struct Metered {
    double time_s;
    ToneCurve wanted;
  };
  std::vector<Metered> metered_;  ///< of the footage's first frames, in the scene of metered_version_
  int metered_version_ = 0;
  std::vector<render::PassTime> pass_times_;
};

/// The part of the settings that the compositor's passes are made by.
render::CompositorSettings compositor_settings(const SceneSettings& scene);

}  // namespace catchlight::app
