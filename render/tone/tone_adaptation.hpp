// How the exposure follows the scene: quickly to bright, slowly to dark, alike at every frame rate.
#pragma once

#include <optional>

#include "catchlight/tone_curve.hpp"
#include "render/tone/tone_curve.hpp"

namespace catchlight::render {

/// Between two frames what the first of them calls for is held, and the stops of gain and white approach it exponentially:
///   E(t) = E* + (E(t0) - E*) exp(-(t - t0) / tau)
/// which is exact, not a step of an integration, and never overshoots; so frames in between change nothing while the scene stands
/// still. tau is that to bright where gain falls (or white rises), else that to dark. A frame itself is drawn with what was
/// before it: its light is seen from its time on. The first frame is drawn adapted.
class ToneAdaptation {
 public:
  /// Time constants; 0: at once, which is with the next frame.
  ToneAdaptation(double bright_s, double dark_s) : bright_s_(bright_s), dark_s_(dark_s) {}

  /// The curve that a frame of this time is drawn with; none before the first was seen. A time before the last frame's counts as
  /// its.
  std::optional<ToneCurve> at(double time_s) const;

  /// Says that the frame of this time calls for `target`.
  void see(double time_s, const ToneCurve& target);

 private:
  double bright_s_, dark_s_;
  std::optional<ToneCurve> seen_from_;  ///< the curve at time_s_
  ToneCurve target_;
  double time_s_ = 0;
};

}  // namespace catchlight::render
