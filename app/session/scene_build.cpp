#include "app/session/scene_build.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "catchlight/util/text.hpp"
#include "render/math/sh.hpp"
#include "render/mesh/bounds.hpp"
#include "render/mesh/mesh_file.hpp"
#include "render/probe/prefilter.hpp"
#include "render/probe/probe_split.hpp"

namespace catchlight::app {
namespace {

/// Light is kept at vertices and interpolated between them, so edges stay short against the object; the cap keeps bakes in
/// seconds.
constexpr double kEdgesAcrossDiagonal = 24;
constexpr std::size_t kMaxVertices = 200'000;

/// How large the object's transfer may become.
constexpr std::size_t kTransferBytes = std::size_t{512} << 20;

/// The rays of all vertices together, so that a million triangles bake in minutes; but never fewer a vertex than kMinRays.
constexpr std::size_t kMaxRays = std::size_t{1} << 26;
constexpr int kMinRays = 64;

/// The error of low-discrepancy rays falls about as one over their number.
constexpr double kRayErrorFactor = 4;

std::string origin_of(const SceneSettings& settings, const std::string& key) {
  return settings.is_by_hand(key) ? "set by hand" : "default";
}

/// A power of two, as low-discrepancy points want it.
int rays_for_tolerance(double tolerance) {
  const auto wanted = static_cast<unsigned>(std::clamp(std::ceil(kRayErrorFactor / tolerance), 64.0, 16384.0));
  return static_cast<int>(std::bit_ceil(wanted));
}

int choose_rays(const SceneSettings& settings, std::size_t vertices, std::vector<PlanEntry>& plan) {
  if (settings.is_by_hand("quality.rays")) {
    plan.push_back({"rays", std::to_string(settings.quality.rays), "set by hand"});
    return settings.quality.rays;
  }
  int rays = rays_for_tolerance(settings.quality.tolerance);
  std::string reason = "for a tolerance of " + number_text(settings.quality.tolerance);
  while (rays > kMinRays && vertices * static_cast<std::size_t>(rays) > kMaxRays) {
    rays /= 2;
    reason = std::to_string(vertices) + " vertices";
  }
  plan.push_back({"rays", std::to_string(rays), reason});
  return rays;
}

/// As many as asked for, or fewer for a mesh whose transfer would not fit the memory set apart for it.
int choose_bands(const SceneSettings& settings, std::size_t vertices, std::vector<PlanEntry>& plan) {
  int bands = settings.quality.bands;
  std::string reason = origin_of(settings, "quality.bands");
  if (!settings.is_by_hand("quality.bands")) {
    while (bands > 3 && vertices * static_cast<std::size_t>(bands * bands) * sizeof(glm::vec3) > kTransferBytes) --bands;
    if (bands < settings.quality.bands) reason = std::to_string(vertices) + " vertices";
  }
  plan.push_back({"bands", std::to_string(bands), reason});
  return bands;
}

/// As the probe saw it. One that turns with the camera shows another surface than the tag's in most frames.
render::ReceiverAlbedo choose_receiver_albedo(BuiltScene& built, const SceneSettings& settings) {
  std::optional<render::ReceiverAlbedo> seen;
  if (!built.light_follows_camera)
    seen = render::albedo_from_probe(built.probe, built.light_from_probe, built.scene.probe_in_tag_m);
  if (seen) {
    built.plan.push_back({"receiver albedo", "seen", "the probe shows the receiver"});
    return *seen;
  }
  if (built.light_follows_camera) {
    built.plan.push_back({"receiver albedo", "constant", "the probe shows another surface"});
    return render::constant_albedo(settings.receiver.albedo);
  }
  built.plan.push_back(
      {"receiver albedo", "none", "more light comes from below than the receiver can send back: it counts as sky"});
  return {};
}

void bake(BuiltScene& built, const SceneSettings& settings, const WarningHandler& warn, const ProgressHandler& progress) {
  const render::Mesh& mesh = built.scene.mesh;
  render::TransferOptions options;
  options.bands = choose_bands(settings, mesh.vertices.size(), built.plan);
  options.rays = built.rays = choose_rays(settings, mesh.vertices.size(), built.plan);
  options.bounces = settings.quality.bounces;
  const bool has_receiver = settings.receiver.plane == ReceiverPlane::tag;
  const render::ReceiverGrid grid =
      has_receiver ? render::receiver_grid_for(mesh, settings.quality.receiver_points) : render::ReceiverGrid{};
  if (has_receiver) options.receiver_albedo = choose_receiver_albedo(built, settings);
  built.transfer_key = render::transfer_key(mesh, grid, options);
  built.scene.transfer = render::load_or_bake_transfer(mesh, grid, options, render::default_cache_folder(), progress, warn,
                                                       &built.transfer_was_cached);
  built.plan.push_back({"bounces", std::to_string(options.bounces), origin_of(settings, "quality.bounces")});
  built.plan.push_back({"shadow",
                        has_receiver ? std::to_string(grid.columns) + "x" + std::to_string(grid.rows) + " points" : "none",
                        has_receiver ? "the object's reach on the tag's plane" : "receiver.plane is \"none\""});
}

void split_off_lights(BuiltScene& built, const SceneSettings& settings) {
  const render::SplitProbe split =
      render::split_lights(built.probe, {built.scene.transfer.bands, settings.quality.tolerance, settings.quality.light_samples});
  built.scene.lights = render::samples_of(split, built.light_from_probe);
  if (!built.scene.lights.empty())
    built.scene.rest_reflections = render::prefilter_reflections(split.mirrored, built.light_from_probe);
  const std::string why = split.lights.empty() ? "nothing in the probe throws a shadow that its bands cannot hold"
                                               : "far brighter than the rest, and sharper than its bands";
  built.plan.push_back({"lights", std::to_string(split.lights.size()), settings.quality.light_samples > 0 ? why : "set by hand"});
  built.plan.push_back(
      {"light samples", std::to_string(built.scene.lights.size()), origin_of(settings, "quality.light_samples")});
}

/// By exact summation over the probe's texels, on the plane with normal tag +z.
glm::dvec3 irradiance_over_pi(const BuiltScene& built, const glm::dmat3& tag_from_light) {
  const glm::dmat3 probe_from_tag = glm::transpose(tag_from_light * built.light_from_probe);
  return render::irradiance(built.probe, probe_from_tag * glm::dvec3(0, 0, 1)) / glm::pi<double>();
}

}  // namespace

render::Probe load_scaled_probe(const SceneSettings& settings, const WarningHandler& warn) {
  if (settings.probe.image.empty())
    throw Error("the scene has no light: give [probe] image = \"FILE\" in the scene file, or --probe.image FILE");
  render::ProbeLoadOptions options;
  options.layout = settings.probe.layout;
  options.strict = settings.probe.strict;
  render::Probe probe = render::load_probe(settings.resolve(settings.probe.image), options, warn);
  const auto gain = static_cast<float>(std::exp2(settings.probe.ev));
  for (float& value : probe.image.data) value *= gain;
  return probe;
}

// The camera's up is -y, and it looks along probe -z.
glm::dmat3 light_from_probe(const SceneSettings::Probe& probe) {
  if (probe.fixed_to == LightFrame::tag) return render::tag_from_probe(probe.up, probe.yaw_deg);
  const glm::dmat3 camera_from_upright(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
  return camera_from_upright * render::tag_from_probe(render::UpAxis::y, probe.yaw_deg);
}

glm::dvec3 probe_in_tag_m(const render::Mesh& mesh) {
  return {0, 0, std::max(render::bounds_of(mesh).max_m.z, 0.0f) / 2};
}

render::Mesh build_mesh(const SceneSettings& settings, const WarningHandler& warn) {
  if (settings.objects.empty())
    throw Error("the scene has no object: give an [[object]] in the scene file, or --object.mesh FILE");
  render::Mesh mesh;
  for (const SceneSettings::Object& object : settings.objects)
    render::append(mesh, render::transformed(render::load_mesh(settings.resolve(object.mesh), warn), object.tag_from_object()));
  const double diagonal_m = render::bounds_of(mesh).diagonal_m();
  render::subdivide_long_edges(mesh, diagonal_m / kEdgesAcrossDiagonal, std::max(kMaxVertices, mesh.vertices.size()));
  return mesh;
}

BuiltScene build_render_scene(const SceneSettings& settings, const WarningHandler& warn, const ProgressHandler& progress) {
  BuiltScene built;
  built.probe = load_scaled_probe(settings, warn);
  built.light_from_probe = light_from_probe(settings.probe);
  built.light_follows_camera = settings.probe.fixed_to == LightFrame::camera;
  built.scene.mesh = build_mesh(settings, warn);
  built.scene.probe_in_tag_m = glm::vec3(probe_in_tag_m(built.scene.mesh));
  bake(built, settings, warn, progress);
  built.scene.light = render::rotate_sh(render::project_to_sh(built.probe, built.scene.transfer.bands), built.light_from_probe);
  built.scene.reflections = render::prefilter_reflections(built.probe, built.light_from_probe);
  split_off_lights(built, settings);
  if (!built.light_follows_camera) built.still_irradiance_over_pi = irradiance_over_pi(built, glm::dmat3(1.0));
  return built;
}

glm::dmat3 tag_from_light(const BuiltScene& built, const RigidTransform& camera_from_tag) {
  return built.light_follows_camera ? glm::transpose(camera_from_tag.rotation) : glm::dmat3(1.0);
}

glm::dvec3 tag_irradiance_over_pi(const BuiltScene& built, const RigidTransform& camera_from_tag) {
  if (!built.light_follows_camera) return built.still_irradiance_over_pi;
  return irradiance_over_pi(built, tag_from_light(built, camera_from_tag));
}

}  // namespace catchlight::app
