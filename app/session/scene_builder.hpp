// Makes what the compositor draws from a scene's settings, part by part: a part is made anew only where what it depends on
// changes.
#pragma once

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/session/plan.hpp"
#include "app/session/scene_files.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/error.hpp"
#include "catchlight/progress.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/probe/probe_lights.hpp"
#include "render/render_scene.hpp"

namespace catchlight::app {

/// The parts of a scene that take time to make. Each depends on those before it that its comment names.
enum class ScenePart {
  probe,            ///< the probe's file
  mesh,             ///< the objects' files and places, and whether a plane hides what is below it
  receiver_albedo,  ///< probe, how it lies, mesh
  transfer,         ///< mesh, receiver's albedo, quality: the bake
  reflections,      ///< probe, light frame: the prefilter
  lights,           ///< probe, light frame, bands, quality: the split and the harmonics
};
inline constexpr std::size_t kSceneParts = 6;

/// How finely light is baked.
enum class BakeFineness {
  full,  ///< as the settings say
  rough  ///< in a fraction of the time, for what moves under a hand; not kept in the cache
};

struct BuiltScene {
  render::RenderScene scene;  ///< light and reflections in the light frame, scaled by probe.ev
  RigidTransform
      tag_from_scene;     ///< the scene frame of scene_in_tag_m(): an object that slides on the receiver changes only this
  render::Probe probe;    ///< the whole light as its file has it
  double light_gain = 1;  ///< 2^probe.ev
  LightOrientation orientation;
  glm::dvec3 still_irradiance_over_pi{0.0};  ///< on the tag, where the light does not follow the camera
  int rays = 0;                              ///< per vertex in the bake
  bool transfer_was_cached = false;
  std::vector<PlanEntry> plan;
  int version = 0;  ///< rises whenever `scene` changes
};

class SceneBuilder {
 public:
  /// Loads probe and mesh: all that the exposure and a path tracer need. Quick. Throws Error naming the file at fault.
  const BuiltScene& load(const SceneSettings& settings, const WarningHandler& warn);

  /// load(), and bakes the transfer or takes it from the cache, prefilters and splits the probe. Where it throws, parts that are
  /// not done yet are made by the next call.
  const BuiltScene& build(const SceneSettings& settings, const WarningHandler& warn, const ProgressHandler& progress,
                          BakeFineness fineness = BakeFineness::full);

  const BuiltScene& scene() const { return built_; }

  /// All files that the objects were read from, those that their models name among them.
  const std::vector<std::string>& mesh_files() const { return mesh_files_; }
  /// The lights that build() split off the probe, brightest first, in the light frame and before probe.ev.
  const std::vector<render::LightSummary>& lights() const { return lights_.lights; }

  /// Whether the objects, their places or the receiver's albedo differ from those of the last bake. Objects that slide on the
  /// receiver together take theirs along.
  bool needs_bake(const SceneSettings& settings) const;

  /// How often a part was made so far.
  int times_made(ScenePart part) const { return parts_[static_cast<std::size_t>(part)].times_made; }

 private:
  struct Part {
    std::optional<std::string> key;  ///< what it was made from
    std::vector<PlanEntry> plan;     ///< what was chosen in making it
    int times_made = 0;
  };
  using Make = std::function<void(std::vector<PlanEntry>& plan)>;
  void renew(ScenePart part, const std::string& key, const Make& make);

  void load_parts(const SceneSettings& settings, const WarningHandler& warn);
  std::string receiver_key(const SceneSettings& settings) const;
  render::ReceiverGrid make_receiver(const SceneSettings& settings, int points, const WarningHandler& warn);
  void bake(const SceneSettings& settings, const WarningHandler& warn, const ProgressHandler& progress, BakeFineness fineness);
  void light(const SceneSettings& settings, const WarningHandler& warn);
  void scale_light();

  BuiltScene built_;
  std::array<Part, kSceneParts> parts_;
  std::vector<std::string> mesh_files_;
  std::string summed_;                  ///< how the probe lay that irradiance_over_pi_ is of
  glm::dvec3 irradiance_over_pi_{0.0};  ///< still_irradiance_over_pi before probe.ev
  std::string probe_content_;           ///< render::content_key of the probe
  render::ReceiverAlbedo receiver_albedo_;
  bool albedo_is_seen_ = false;  ///< by the probe: it turns with that
  // The light as the probe's file has it, before probe.ev.
  render::ReflectionMap reflections_;
  render::ProbeLights lights_;
  std::string drawn_;  ///< the making of `scene` as it is: how often each part in it had been made, and the gain
};

/// Irradiance / pi on the printed tag, unshadowed, probe.ev applied: what white paper of albedo 1 would send back. The reference
/// for exposure matching.
glm::dvec3 tag_irradiance_over_pi(const BuiltScene& built, const RigidTransform& camera_from_tag);

}  // namespace catchlight::app
