// Draws the virtual layer and puts it into the frame: the face that every renderer has.
#pragma once

#include <string>
#include <vector>

#include "catchlight/composite.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/tone_curve.hpp"
#include "render/frame_view.hpp"
#include "render/pass_time.hpp"

namespace catchlight::render {

/// A renderer of one scene: `GlCompositor` or `CpuCompositor`. The same input gives the same bytes; no state but buffers, and
/// what never changes of the scene, is kept between frames.
class Compositor {
 public:
  virtual ~Compositor() = default;

  /// The frame with the virtual layer in it. With layers there is no tone curve: they are the scene's light, for a compositing
  /// package to expose. `take`: takes the pixels where there are neither layers nor a tone curve, which need the whole picture,
  /// and if the renderer can; then the result has none.
  virtual Composite render(const FrameView& view, const PlateReader& plate, bool want_layers = false,
                           const CompositeSink& take = {}) = 0;

  /// The curve that the frame calls for (Composite::tone_wanted) alone: nothing is coded.
  virtual ToneCurve meter(const FrameView& view, const PlateReader& plate) = 0;

  /// How long the last frame's passes took.
  virtual const std::vector<PassTime>& pass_times() const = 0;

 protected:
  Compositor() = default;
  Compositor(Compositor&&) noexcept = default;
  Compositor& operator=(Compositor&&) noexcept = default;
};

}  // namespace catchlight::render
