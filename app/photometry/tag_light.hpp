// What a frame shows of the tag's white and black, and of the surface around it.
#pragma once

#include <optional>
#include <string>

#include "app/media/pixels/frame.hpp"
#include "app/settings/scene_settings.hpp"
#include "app/track_export/track_file.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tracking/camera/plane_light.hpp"

namespace catchlight::app {

class TagLight {
 public:
  TagLight(const CameraModel& camera, const SceneSettings& scene) : camera_(camera), target_(scene.tag.target()) {}

  struct Reading {
    tracking::TagPhotometry photometry;
    BundledTag tag;  ///< of a board, the first that can be read without clipping, else the first that can be read
  };

  /// Empty where the row's pose is not of this frame: one that was only predicted may not lie on the cells.
  std::optional<Reading> read(const Frame& frame, const TrackRow& row) const;

  /// Of the plane that `tag` lies in; nothing known where it is out of sight.
  tracking::PlaneLight plane(const Frame& frame, const RigidTransform& camera_from_tag, const BundledTag& tag) const;

 private:
  CameraModel camera_;
  TagTarget target_;
};

/// What the user should know where of `drawn` frames the exposure of `held` was not to be read, or of `guessed` only by the black
/// cells; empty where all is well.
std::optional<std::string> exposure_warning(std::int64_t drawn, std::int64_t held, std::int64_t guessed);

}  // namespace catchlight::app
