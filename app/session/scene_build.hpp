// From a scene file's settings to what the compositor draws.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "app/session/report.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/error.hpp"
#include "catchlight/progress.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/mesh/mesh.hpp"
#include "render/probe/probe.hpp"
#include "render/render_scene.hpp"
#include "render/transfer/transfer.hpp"

namespace catchlight::app {

struct BuiltScene {
  render::RenderScene scene;
  render::Probe probe;                       ///< the whole light, scaled by probe.ev
  glm::dmat3 light_from_probe{1.0};          ///< the frame of scene.light and scene.reflections
  bool light_follows_camera = false;         ///< probe.fixed_to = "camera": the light frame is the camera's, else the tag's
  glm::dvec3 still_irradiance_over_pi{0.0};  ///< on the tag, where the light does not follow the camera
  int rays = 0;                              ///< per vertex in the bake
  std::string transfer_key;                  ///< names the bake in the cache
  bool transfer_was_cached = false;
  std::vector<PlanEntry> plan;
};

/// Loads meshes and probe, bakes the transfer or takes it from the cache. Throws Error naming the file at fault.
BuiltScene build_render_scene(const SceneSettings& settings, const WarningHandler& warn, const ProgressHandler& progress);

/// The objects in the tag frame as one mesh, fine enough for light kept at its vertices.
render::Mesh build_mesh(const SceneSettings& settings, const WarningHandler& warn);

/// The probe, scaled by probe.ev. Throws Error where the scene names none.
render::Probe load_scaled_probe(const SceneSettings& settings, const WarningHandler& warn);

/// Takes probe directions to the light frame: the tag's, or the camera's where probe.fixed_to is "camera".
glm::dmat3 light_from_probe(const SceneSettings::Probe& probe);

/// Where the probe was captured: on the tag's axis, at half the object's height.
glm::dvec3 probe_in_tag_m(const render::Mesh& mesh);

/// For FrameView: the identity unless the light follows the camera.
glm::dmat3 tag_from_light(const BuiltScene& built, const RigidTransform& camera_from_tag);

/// Irradiance / pi on the printed tag, unshadowed: what white paper of albedo 1 would send back. The reference for exposure
/// matching.
glm::dvec3 tag_irradiance_over_pi(const BuiltScene& built, const RigidTransform& camera_from_tag);

}  // namespace catchlight::app
