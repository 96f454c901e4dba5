// How far the drawn pose's corners are from those that one frame shows.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "app/media/pixels/frame.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

/// A tag's corners, in pixels of the frame.
struct CornerResiduals {
  int id = 0;
  std::array<glm::dvec2, 4> drawn_px{};  ///< by the pose that the object is drawn with
  std::array<glm::dvec2, 4> seen_px{};   ///< found in this frame alone, by the tag's outer edges
};

/// The residuals of every tag of the target that is detected in the frame. They do not depend on what the track knows of others.
std::vector<CornerResiduals> corner_residuals(const Frame& frame, const TrackRow& row, const CameraModel& camera,
                                              const SceneSettings& scene);

/// The root of the mean square distance of all corners; 0 without any.
double rms_px(const std::vector<CornerResiduals>& residuals);

}  // namespace catchlight::app
