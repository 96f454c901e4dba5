// What an export says of a shot.
#pragma once

#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"

namespace catchlight::app {

/// What an export says besides the track itself.
struct Shot {
  CameraModel camera;
  SceneSettings scene;
  bool is_sequence = false;  ///< frames have their files' own numbers
};

}  // namespace catchlight::app
