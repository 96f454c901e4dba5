#include "app/session/scene_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/file_stamp.hpp"
#include "catchlight/util/text.hpp"
#include "render/cache/content_cache.hpp"
#include "render/made_probe/made_probe.hpp"
#include "render/math/sh.hpp"
#include "render/mesh/bounds.hpp"
#include "render/mesh/test_objects.hpp"
#include "render/mesh_file/mesh_file.hpp"
#include "render/receiver_light.hpp"
#include "render/split_light.hpp"

namespace catchlight::app {
namespace {

/// The memory that the object's transfer may take.
constexpr std::size_t kTransferBytes = std::size_t{512} << 20;

/// Rays of all vertices together, so that a million triangles bake in minutes; a vertex has kMinRays at least.
constexpr std::size_t kMaxRays = std::size_t{1} << 26;
constexpr int kMinRays = 64;

/// The error of low-discrepancy rays falls about as one over their number.
constexpr double kRayErrorFactor = 4;

std::string origin_of(const SceneSettings& settings, const std::string& key) {
  return settings.is_by_hand(key) ? "set by hand" : "default";
}

/// The rays that a tolerance needs: a power of two, as low-discrepancy points want it.
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
  std::string reason = "for a tolerance of " + plain_text(settings.quality.tolerance);
  while (rays > kMinRays && vertices * static_cast<std::size_t>(rays) > kMaxRays) {
    rays /= 2;
    reason = std::to_string(vertices) + " vertices";
  }
  plan.push_back({"rays", std::to_string(rays), reason});
  return rays;
}

/// As many bands as asked for, or fewer for a mesh whose transfer would not fit the memory set apart for it.
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

std::string text_of(const glm::dvec3& v) {
  return number_text(v.x) + ' ' + number_text(v.y) + ' ' + number_text(v.z) + ' ';
}

std::string probe_key(const SceneSettings& settings) {
  const SceneSettings::Probe& probe = settings.probe;
  if (render::is_made_probe(probe.image)) return probe.image + (is_light_guessed(settings) ? " guessed" : "");
  return file_stamp(settings.resolve(probe.image)) + (probe.layout ? name_of(*probe.layout) : "auto") +
         (probe.strict ? " strict" : "");
}

std::vector<std::string> files_of_objects(const SceneSettings& settings) {
  std::vector<std::string> files;
  for (const SceneSettings::Object& object : settings.objects)
    for (const std::string& file : render::files_of_mesh(settings.resolve(object.mesh))) files.push_back(file);
  return files;
}

/// `files`: those that the objects were read from.
std::string mesh_key(const SceneSettings& settings, const std::vector<std::string>& files) {
  std::string key = name_of(settings.receiver.plane) + std::string("\n");
  for (const std::string& file : files) key += file_stamp(file);
  for (const SceneSettings::Object& object : settings.objects) {
    key += settings.resolve(object.mesh) + '\n';
    if (std::ranges::count(render::kTestObjects, object.mesh) > 0) key += number_text(settings.tag.size_m) + '\n';
    glm::dmat4 place = object.tag_from_object();
    place[3] -= glm::dvec4(scene_in_tag_m(settings), 0);
    for (int column = 0; column < 4; ++column) key += text_of(place[column]);
  }
  return key;
}

std::string frame_key(const glm::dmat3& rotation) {
  return text_of(rotation[0]) + text_of(rotation[1]) + text_of(rotation[2]);
}

/// Irradiance / pi on the plane with normal tag +z, by exact summation over the probe's texels.
glm::dvec3 irradiance_over_pi(const BuiltScene& built, const glm::dmat3& tag_from_light) {
  const glm::dmat3 probe_from_tag = glm::transpose(tag_from_light * built.orientation.light_from_probe);
  return render::irradiance(built.probe, probe_from_tag * glm::dvec3(0, 0, 1)) / glm::pi<double>();
}

/// What is enough while something moves.
SceneSettings::Quality roughened(SceneSettings::Quality quality) {
  constexpr int kRays = 64, kBounces = 1, kReceiverPoints = 32;
  quality.rays = std::min(quality.rays, kRays);
  quality.bounces = std::min(quality.bounces, kBounces);
  quality.receiver_points = std::min(quality.receiver_points, kReceiverPoints);
  return quality;
}

/// The surface around the tag as the probe saw it. A probe that turns with the camera shows another one in most frames.
render::ReceiverAlbedo choose_receiver_albedo(const BuiltScene& built, const std::string& probe_key, const glm::dvec3& given,
                                              const WarningHandler& warn, std::vector<PlanEntry>& plan) {
  if (built.orientation.follows_camera) {
    plan.push_back({"receiver albedo", "constant", "the probe shows another surface"});
    return render::constant_albedo(given);
  }
  const glm::dmat3 tag_from_probe = built.orientation.fixed_from_light * built.orientation.light_from_probe;
  if (const auto seen = render::load_or_find_albedo(built.probe, probe_key, tag_from_probe, built.scene.probe_in_tag_m,
                                                    render::ContentCache(""), warn)) {
    plan.push_back({"receiver albedo", "seen", "the probe shows the receiver"});
    return *seen;
  }
  plan.push_back({"receiver albedo", "none", "more light comes from below than the receiver can send back: it counts as sky"});
  return {};
}

render::ReflectionMap scaled(render::ReflectionMap map, float gain) {
  for (Image& level : map.levels)
    for (float& value : level.data) value *= gain;
  return map;
}

/// How finely the lights' shadows on the receiver are drawn.
PlanEntry shadow_texels_entry(const render::RenderScene& scene) {
  const std::string name = "shadow texels";
  if (scene.transfer.grid.columns < 2) return {name, "none", "receiver.plane is \"none\""};
  const render::Bounds box = render::bounds_of(scene.mesh);
  const render::OpenPlaneLight open = render::open_plane_light(scene.transfer.receiver_unshadowed, render::split_light(scene));
  const render::PlaneRect reach = render::shadow_reach(scene.lights, open, box);
  if (reach.empty()) return {name, "none", "no light throws a shadow on the tag's plane that can be seen"};
  const glm::ivec2 size = render::receiver_texels(reach, box).size;
  return {name, std::to_string(size.x) + "x" + std::to_string(size.y),
          "192 across the object, as far as its lights' shadows reach"};
}

}  // namespace

/// Makes the part where `key` is not what it was made from, and keeps what `make` adds to the plan.
void SceneBuilder::renew(ScenePart name, const std::string& key, const Make& make) {
  Part& part = parts_[static_cast<std::size_t>(name)];
  if (part.key != key) {
    part.key.reset();
    part.plan.clear();
    make(part.plan);
    part.key = key;
    ++part.times_made;
  }
  built_.plan.insert(built_.plan.end(), part.plan.begin(), part.plan.end());
}

void SceneBuilder::load_parts(const SceneSettings& settings, const WarningHandler& warn) {
  built_.plan.clear();
  renew(ScenePart::probe, probe_key(settings), [&](auto& plan) {
    built_.probe = load_scene_probe(settings, warn);
    if (render::is_made_probe(settings.probe.image))
      plan.push_back({"probe", settings.probe.image, is_light_guessed(settings) ? "a guess: none is given" : "set by hand"});
    probe_content_ = render::content_key(built_.probe);
  });
  // Which files there are is asked only where a change shows in those that are known: to find them, they must be read.
  std::string key = mesh_key(settings, mesh_files_);
  if (parts_[static_cast<std::size_t>(ScenePart::mesh)].key != key) {
    mesh_files_ = files_of_objects(settings);
    key = mesh_key(settings, mesh_files_);
  }
  renew(ScenePart::mesh, key, [&](auto&) {
    built_.scene.mesh = load_objects(settings, warn);
    built_.scene.probe_in_tag_m = glm::vec3(probe_in_scene_m(built_.scene.mesh));
  });
  built_.tag_from_scene.translation_m = scene_in_tag_m(settings);
  built_.light_gain = std::exp2(settings.probe.ev);
  built_.orientation = light_orientation(settings.probe);
  const glm::dmat3& fixed_from_light = built_.orientation.fixed_from_light;
  const std::string lie = probe_key(settings) + (built_.orientation.follows_camera ? " camera " : " tag ") +
                          frame_key(fixed_from_light * built_.orientation.light_from_probe);
  if (summed_ != lie)
    irradiance_over_pi_ = built_.orientation.follows_camera ? glm::dvec3(0.0) : irradiance_over_pi(built_, fixed_from_light);
  summed_ = lie;
  built_.still_irradiance_over_pi = built_.light_gain * irradiance_over_pi_;
}

/// What the receiver's albedo is made from.
std::string SceneBuilder::receiver_key(const SceneSettings& settings) const {
  const LightOrientation orientation = light_orientation(settings.probe);
  return probe_key(settings) + mesh_key(settings, mesh_files_) + (orientation.follows_camera ? " camera " : " tag ") +
         frame_key(orientation.fixed_from_light * orientation.light_from_probe) + text_of(settings.receiver.albedo);
}

/// The surface that the objects stand on: its grid, and what it sends back.
render::ReceiverGrid SceneBuilder::make_receiver(const SceneSettings& settings, int points, const WarningHandler& warn) {
  if (settings.receiver.plane != ReceiverPlane::tag) return {};
  renew(ScenePart::receiver_albedo, receiver_key(settings), [&](auto& plan) {
    receiver_albedo_ = choose_receiver_albedo(built_, probe_content_, settings.receiver.albedo, warn, plan);
    albedo_is_seen_ = receiver_albedo_.known() && !built_.orientation.follows_camera;
  });
  return render::receiver_grid_for(built_.scene.mesh, points);
}

void SceneBuilder::bake(const SceneSettings& settings, const WarningHandler& warn, const ProgressHandler& progress,
                        BakeFineness fineness) {
  const bool is_rough = fineness == BakeFineness::rough, has_receiver = settings.receiver.plane == ReceiverPlane::tag;
  const render::Mesh& mesh = built_.scene.mesh;
  SceneSettings::Quality quality = settings.quality;
  quality.bands = choose_bands(settings, mesh.vertices.size(), built_.plan);
  quality.rays = choose_rays(settings, mesh.vertices.size(), built_.plan);
  if (is_rough) quality = roughened(quality);
  built_.rays = quality.rays;
  render::TransferOptions options{.bands = quality.bands, .rays = quality.rays, .bounces = quality.bounces};
  const render::ReceiverGrid grid = make_receiver(settings, quality.receiver_points, warn);
  if (has_receiver) options.receiver_albedo = receiver_albedo_;
  // The mesh itself is hashed only where it is a new one, for it may be large; the grid follows from it.
  render::ContentHash albedo;
  albedo.add(options.receiver_albedo.seen_from_m);
  albedo.add(options.receiver_albedo.image.data);
  std::string key = std::to_string(times_made(ScenePart::mesh)) + ' ' + albedo.text();
  for (const int number : {grid.columns, grid.rows, options.bands, options.rays, options.bounces})
    key += ' ' + std::to_string(number);
  renew(ScenePart::transfer, key, [&](auto&) {
    render::RenderScene& scene = built_.scene;
    built_.transfer_was_cached = false;
    scene.transfer_key = is_rough ? "" : render::transfer_key(mesh, grid, options);
    scene.transfer = is_rough ? render::bake_transfer(mesh, grid, options, progress)
                              : render::load_or_bake_transfer(mesh, grid, options, render::default_cache_folder(), progress, warn,
                                                              &built_.transfer_was_cached);
  });
  built_.plan.push_back({"bounces", std::to_string(options.bounces), origin_of(settings, "quality.bounces")});
  built_.plan.push_back({"shadow",
                         has_receiver ? std::to_string(grid.columns) + "x" + std::to_string(grid.rows) + " points" : "none",
                         has_receiver ? "the object's reach on the tag's plane" : "receiver.plane is \"none\""});
}

void SceneBuilder::light(const SceneSettings& settings, const WarningHandler& warn) {
  const render::ContentCache cache("");
  const glm::dmat3& light_from_probe = built_.orientation.light_from_probe;
  const std::string key = probe_key(settings) + frame_key(light_from_probe);
  renew(ScenePart::reflections, key,
        [&](auto&) { reflections_ = render::load_or_prefilter(built_.probe, probe_content_, light_from_probe, cache, warn); });
  const render::SplitOptions options{built_.scene.transfer.bands, settings.quality.tolerance, settings.quality.light_samples};
  const std::string split_key = key + number_text(options.bands) + ' ' + number_text(options.tolerance) + ' ' +
                                number_text(options.max_samples) + origin_of(settings, "quality.light_samples");
  renew(ScenePart::lights, split_key, [&](std::vector<PlanEntry>& plan) {
    lights_ = render::load_or_split(built_.probe, probe_content_, light_from_probe, options, cache, warn);
    const std::string why = lights_.lights.empty() ? "nothing in the probe throws a shadow that its bands cannot hold"
                                                   : "far brighter than the rest, and sharper than its bands";
    plan.push_back({"lights", std::to_string(lights_.lights.size()), options.max_samples > 0 ? why : "set by hand"});
    plan.push_back({"light samples", std::to_string(lights_.samples.size()), origin_of(settings, "quality.light_samples")});
  });
}

/// Light is linear: a brighter probe is the same light times a number.
void SceneBuilder::scale_light() {
  render::RenderScene& scene = built_.scene;
  scene.light = lights_.harmonics;
  for (glm::vec3& coefficient : scene.light) coefficient *= static_cast<float>(built_.light_gain);
  scene.lights = lights_.samples;
  for (render::LightSample& sample : scene.lights) sample.irradiance *= built_.light_gain;
  scene.reflections = scaled(reflections_, static_cast<float>(built_.light_gain));
  scene.rest_reflections = scaled(lights_.rest_reflections, static_cast<float>(built_.light_gain));
}

bool SceneBuilder::needs_bake(const SceneSettings& settings) const {
  const auto differs = [&](ScenePart part, const std::string& key) { return parts_[static_cast<std::size_t>(part)].key != key; };
  return differs(ScenePart::mesh, mesh_key(settings, mesh_files_)) ||
         (albedo_is_seen_ && differs(ScenePart::receiver_albedo, receiver_key(settings)));
}

const BuiltScene& SceneBuilder::load(const SceneSettings& settings, const WarningHandler& warn) {
  load_parts(settings, warn);
  return built_;
}

const BuiltScene& SceneBuilder::build(const SceneSettings& settings, const WarningHandler& warn, const ProgressHandler& progress,
                                      BakeFineness fineness) {
  load_parts(settings, warn);
  bake(settings, warn, progress, fineness);
  light(settings, warn);
  std::string drawn = number_text(built_.light_gain);
  for (const ScenePart part : {ScenePart::mesh, ScenePart::transfer, ScenePart::reflections, ScenePart::lights})
    drawn += ' ' + std::to_string(times_made(part));
  if (drawn != drawn_) {
    scale_light();
    drawn_ = drawn;
    ++built_.version;
  }
  built_.plan.push_back(shadow_texels_entry(built_.scene));
  return built_;
}

glm::dvec3 tag_irradiance_over_pi(const BuiltScene& built, const RigidTransform& camera_from_tag) {
  if (!built.orientation.follows_camera) return built.still_irradiance_over_pi;
  return built.light_gain * irradiance_over_pi(built, built.orientation.tag_from_light(camera_from_tag.rotation));
}

}  // namespace catchlight::app
