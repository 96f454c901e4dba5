// What a change of settings asks to be done again.
#pragma once

#include <set>

#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// The part of an opened shot that a parameter belongs to. What is made from that part follows it.
enum class ChangeCost {
  view,    ///< nothing that is kept: the next frame is drawn with it
  passes,  ///< the compositor's passes
  light,   ///< the probe and what is made of it: lights, harmonics, reflections, and the receiver's albedo where it shows that
  bake,    ///< the transfer, and the light that is split by its bands
  mesh,    ///< the objects' meshes in their places
  track,   ///< the track: every frame is looked at again
  footage  ///< the footage: its codes stand for other light
};

/// What differs between two scenes, parameter by parameter; empty where nothing does.
std::set<ChangeCost> costs_of_change(const SceneSettings& before, const SceneSettings& after);

}  // namespace catchlight::app
