// Draws the virtual layer and puts it into the frame. Never knows whether a window exists: draws into its own framebuffers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catchlight/composite.hpp"
#include "catchlight/plate.hpp"
#include "render/frame_view.hpp"
#include "render/pass_time.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

/// The compositor needs a current GL 4.5 core context for its whole life. Throws Error where a shader does not compile (file and
/// log) or a texture is too large.
class Compositor {
 public:
  Compositor(const RenderScene& scene, const CompositorSettings& settings);
  ~Compositor();
  Compositor(Compositor&&) noexcept;
  Compositor& operator=(Compositor&&) noexcept;

  /// The frame with the virtual layer in it. The same input gives the same bytes; no state but buffers is kept between frames.
  /// With layers there is no tone curve: they are the scene's light, for a compositing package to expose.
  Composite render(const FrameView& view, const PlateReader& plate, bool want_layers = false);

  /// The curve that the frame calls for (Composite::tone_wanted) alone: it is drawn, but neither coded nor read back.
  ToneCurve meter(const FrameView& view, const PlateReader& plate);

  /// How long the last frame's passes took.
  const std::vector<PassTime>& pass_times() const;

  /// Compiles anew what was edited in the settings' shader_folder; a program that does not compile stays as it was. Returns what
  /// is wrong with those, by file and line.
  std::vector<std::string> reload_shaders();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catchlight::render
