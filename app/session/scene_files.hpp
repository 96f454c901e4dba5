// What a scene's files hold: its objects as one mesh, its light probe, and how the probe's directions lie.
#pragma once

#include <glm/glm.hpp>

#include "app/settings/scene_settings.hpp"
#include "catchlight/error.hpp"
#include "render/mesh/mesh.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::app {

/// The scene frame: the tag frame moved along the tag's plane to the first object's origin. What is made of the objects is the
/// same wherever on the plane they lie together.
glm::dvec3 scene_in_tag_m(const SceneSettings& settings);

/// The objects in the scene frame as one mesh, fine enough for light kept at its vertices. What lies below a receiver is not
/// there; a warning says how far an object reaches below it. Throws Error where the scene has none, where nothing is left of it,
/// and as render::load_mesh.
render::Mesh load_objects(const SceneSettings& settings, const WarningHandler& warn);

/// The probe as its file has it, or as it is made: probe.ev is not applied. Warns where the scene names none. Throws Error as
/// render::load_probe and render::make_probe.
render::Probe load_scene_probe(const SceneSettings& settings, const WarningHandler& warn);

/// Whether the scene names no probe, so that its light is the program's guess.
bool is_light_guessed(const SceneSettings& settings);

/// How the light lies. The light frame is the frame of what the light is fixed to (the tag, or the camera) without the probe's
/// yaw, so that nothing that is made of the probe in the light frame depends on the yaw.
struct LightOrientation {
  glm::dmat3 light_from_probe{1.0};
  glm::dmat3 fixed_from_light{1.0};  ///< the yaw: takes the light frame to the frame of what the light is fixed to
  bool follows_camera = false;       ///< the light is fixed to the camera instead of the tag

  /// Takes the light frame to that of a tag which the camera sees in this rotation.
  glm::dmat3 tag_from_light(const glm::dmat3& camera_from_tag_rotation) const {
    return follows_camera ? glm::transpose(camera_from_tag_rotation) * fixed_from_light : fixed_from_light;
  }
};

LightOrientation light_orientation(const SceneSettings::Probe& probe);

/// The place where the probe is taken to have been captured: above the object's foot, at half its height. The foot is the scene
/// frame's origin where that lies under the mesh, else the middle of what does.
glm::dvec3 probe_in_scene_m(const render::Mesh& mesh_scene);

}  // namespace catchlight::app
