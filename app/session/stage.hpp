// A scene ready to be drawn, and what draws it frame after frame.
#pragma once

#include <memory>
#include <vector>

#include "app/media/pixels/frame.hpp"
#include "app/session/report.hpp"
#include "app/session/scene_build.hpp"
#include "app/support/log.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/track.hpp"
#include "render/compositor.hpp"
#include "render/frame_view.hpp"
#include "render/gl/gl_context.hpp"
#include "render/pass_time.hpp"
#include "render/tone/tone_adaptation.hpp"

namespace catchlight::app {

/// A scene ready to be drawn, with the GL context it lives in.
struct Stage {
  std::unique_ptr<render::GlContext> context;
  BuiltScene built;
  std::unique_ptr<render::Compositor> compositor;
  bool draws_debug = false;  ///< over every finished frame, as app/session/debug_drawing.hpp says
};

/// Loads, bakes and uploads; adds plan and renderer to the report. Throws Error.
Stage build_stage(const SceneSettings& scene, Log& log, Report& report);

/// Draws frame after frame. Exposure "auto" adapts to what it has seen: it must see every frame of the footage, in order.
class FrameDrawing {
 public:
  /// `stage` and `scene` must live as long.
  FrameDrawing(Stage& stage, const SceneSettings& scene, const CameraModel& camera, bool want_layers);

  Composite draw(const Frame& frame, const TrackRow& row);

  /// Of a frame that is not written.
  void pass_over(const Frame& frame, const TrackRow& row);

  /// Of the last draw(); empty where nothing was drawn.
  const std::vector<render::PassTime>& pass_times() const { return pass_times_; }

 private:
  bool adapts() const;
  render::FrameView view_of(const Frame& frame, const TrackRow& row) const;

  Stage& stage_;
  const SceneSettings& scene_;
  CameraModel camera_;
  bool want_layers_;
  render::ToneAdaptation adaptation_;
  std::vector<render::PassTime> pass_times_;
};

}  // namespace catchlight::app
