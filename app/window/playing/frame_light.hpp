// The light of a frame, for those who look at it and turn it by hand.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "app/session/frame_job.hpp"
#include "app/session/scene_builder.hpp"
#include "render/probe/probe.hpp"
#include "render/probe/probe_lights.hpp"

namespace catchlight::app {

/// The scene's probe, small enough to be drawn at once.
struct SmallProbe {
  render::Probe probe;                       ///< latlong, in the probe's own frame, before probe.ev
  std::vector<render::LightSummary> lights;  ///< brightest first, in the light frame, before probe.ev
};

struct FrameLight {
  std::shared_ptr<const SmallProbe> probe;  ///< null where the frame shows nothing of the scene
  glm::dvec3 exposure{1.0};                 ///< light in the picture of one unit of the probe's radiance, probe.ev included
  glm::dvec3 paper{0.0};  ///< light of white paper on the tag in the virtual layer, before exposure.white_balance and black
  glm::dvec3 black{0.0};
};

/// Makes the light of frames, and the small probe anew where the scene has another.
class FrameLightMaker {
 public:
  /// `job`: rendered under these settings.
  FrameLight light_of(const FrameJob& job, const SceneSettings& settings, const SceneBuilder& builder);

 private:
  std::shared_ptr<const SmallProbe> probe_;
  int probe_version_ = 0, lights_version_ = 0;  ///< of `probe_`: how often the parts had been made
};

}  // namespace catchlight::app
