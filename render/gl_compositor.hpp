// The compositor on OpenGL. Never knows whether a window exists: draws into its own framebuffers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/compositor.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

class ShaderLibrary;

/// Needs a current GL 4.5 core context for its whole life. Throws Error where a shader does not compile (file and log) or a
/// texture is too large.
class GlCompositor final : public Compositor {
 public:
  /// `shaders`: what compositors that follow each other have compiled in common, of the settings' shader_folder; null: its own.
  GlCompositor(const RenderScene& scene, const CompositorSettings& settings, std::shared_ptr<ShaderLibrary> shaders = nullptr);
  ~GlCompositor() override;
  GlCompositor(GlCompositor&&) noexcept;
  GlCompositor& operator=(GlCompositor&&) noexcept;

  Composite render(const FrameView& view, const PlateReader& plate, bool want_layers = false,
                   const CompositeSink& take = {}) override;
  ToneCurve meter(const FrameView& view, const PlateReader& plate) override;
  const std::vector<PassTime>& pass_times() const override;

  /// Compiles anew what was edited in the settings' shader_folder; a program that does not compile stays as it was. Returns what
  /// is wrong with those, by file and line.
  std::vector<std::string> reload_shaders();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catchlight::render
