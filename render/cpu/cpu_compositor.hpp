// The compositor on processors: no GL, all cores. What stands still in the tag's frame (direct light, shadows, transfer) is found
// when the light turns, and kept.
#pragma once

#include <memory>
#include <vector>

#include "render/compositor.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

class CpuCompositor final : public Compositor {
 public:
  /// Throws Error where the scene's parts do not fit together.
  CpuCompositor(const RenderScene& scene, const CompositorSettings& settings);
  ~CpuCompositor() override;

  Composite render(const FrameView& view, const PlateReader& plate, bool want_layers = false,
                   const CompositeSink& take = {}) override;
  ToneCurve meter(const FrameView& view, const PlateReader& plate) override;
  const std::vector<PassTime>& pass_times() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catchlight::render
