#include "app/session/scene_files.hpp"

#include <algorithm>
#include <filesystem>

#include "catchlight/util/text.hpp"
#include "render/made_probe/made_probe.hpp"
#include "render/mesh/bounds.hpp"
#include "render/mesh/test_objects.hpp"
#include "render/mesh_file/mesh_file.hpp"

namespace catchlight::app {
namespace {

/// Light is kept at vertices and interpolated between them, so edges stay short against the object; the cap keeps bakes in
/// seconds.
constexpr double kEdgesAcrossDiagonal = 24;
constexpr std::size_t kMaxVertices = 200'000;

/// An object that reaches less than this share of its size below the tag's plane stands on it: that is rounding.
constexpr float kRounding = 1e-4f;

/// It may sink by this share of its size without a word.
constexpr float kQuietlySunk = 0.01f;

constexpr const char* kAdvice = "raise it by tag_from_object.translation_m, or let receiver.plane be \"none\"";

glm::dmat4 scene_from(const SceneSettings& settings, const SceneSettings::Object& object) {
  glm::dmat4 scene_from_object = object.tag_from_object();
  scene_from_object[3] -= glm::dvec4(scene_in_tag_m(settings), 0);
  return scene_from_object;
}

/// A test object stands where tag_from_object puts its origin, whatever model it turns upright.
render::Mesh placed_object(const SceneSettings& settings, const SceneSettings::Object& object, const WarningHandler& warn) {
  const glm::dmat4 scene_from_object = scene_from(settings, object);
  const std::optional<render::Mesh> shape = render::test_object(object.mesh, settings.tag.size_m);
  if (!shape) return render::transformed(render::load_mesh(settings.resolve(object.mesh), warn), scene_from_object);
  render::Mesh placed = render::transformed(*shape, scene_from_object);
  const float lift_m = static_cast<float>(scene_from_object[3].z) - render::bounds_of(placed).min_m.z;
  for (render::Vertex& vertex : placed.vertices) vertex.position_m.z += lift_m;
  return placed;
}

/// The tag's plane is opaque: what is below is not there.
void hide_below_plane(const SceneSettings::Object& object, render::Mesh& part, const WarningHandler& warn) {
  const render::Bounds bounds = render::bounds_of(part);
  const float depth_m = -bounds.min_m.z;
  if (!(depth_m > kRounding * bounds.diagonal_m())) return;
  part = render::upper_half(part);
  if (depth_m > kQuietlySunk * bounds.diagonal_m() && warn) {
    warn(object.mesh + ": the object reaches " + length_text(depth_m) + " below the tag, whose plane hides " +
         (part.indices.empty() ? "all of it" : "that part of it") + ": " + kAdvice);
  }
}

/// A name that is no file's and has no extension is likely to be meant for a probe that is made.
void check_name(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  if (name.substr(0, name.find(':')).find('.') != std::string::npos || std::filesystem::exists(path)) return;
  try {
    render::make_probe(name);
  } catch (const Error& error) {
    throw Error(path + ": there is no such file; " + error.what());
  }
}

/// The camera's up is -y, and it looks along probe -z.
const glm::dmat3 kCameraFromUpright(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));

}  // namespace

glm::dvec3 scene_in_tag_m(const SceneSettings& settings) {
  if (settings.objects.empty()) return glm::dvec3(0);
  return {glm::dvec2(settings.objects[0].tag_from_object()[3]), 0};
}

render::Mesh load_objects(const SceneSettings& settings, const WarningHandler& warn) {
  if (settings.objects.empty())
    throw Error("the scene has no object: give an [[object]] in the scene file, or --object.mesh FILE");
  render::Mesh mesh;
  for (const SceneSettings::Object& object : settings.objects) {
    render::Mesh part = placed_object(settings, object, warn);
    if (settings.receiver.plane == ReceiverPlane::tag) hide_below_plane(object, part, warn);
    render::append(mesh, part);
  }
  if (mesh.indices.empty())
    throw Error("nothing of the scene's objects is above the tag, whose plane hides what is below: " + std::string(kAdvice));
  const double diagonal_m = render::bounds_of(mesh).diagonal_m();
  render::subdivide_long_edges(mesh, diagonal_m / kEdgesAcrossDiagonal, std::max(kMaxVertices, mesh.vertices.size()));
  return mesh;
}

render::Probe load_scene_probe(const SceneSettings& settings, const WarningHandler& warn) {
  const std::string& image = settings.probe.image;
  if (is_light_guessed(settings) && warn)
    warn("no light probe is given: \"" + image +
         "\" is a guess; give [probe] image = \"FILE\" in the scene file, or --probe.image " +
         "FILE, or say \"overcast\", \"studio\" or \"sky\" for FILE");
  if (render::is_made_probe(image)) return render::make_probe(image);
  check_name(settings.resolve(image));
  render::ProbeLoadOptions options;
  options.layout = settings.probe.layout;
  options.strict = settings.probe.strict;
  return render::load_probe(settings.resolve(image), options, warn);
}

bool is_light_guessed(const SceneSettings& settings) {
  return !settings.is_by_hand("probe.image") && settings.probe.image == SceneSettings().probe.image;
}

LightOrientation light_orientation(const SceneSettings::Probe& probe) {
  LightOrientation orientation;
  orientation.follows_camera = probe.fixed_to == LightFrame::camera;
  const render::UpAxis up = orientation.follows_camera ? render::UpAxis::y : probe.up;
  const glm::dmat3 fixed_from_upright = orientation.follows_camera ? kCameraFromUpright : glm::dmat3(1.0);
  orientation.light_from_probe = fixed_from_upright * render::tag_from_probe(up, 0);
  if (probe.yaw_deg != 0)
    orientation.fixed_from_light =
        fixed_from_upright * render::tag_from_probe(up, probe.yaw_deg) * glm::transpose(orientation.light_from_probe);
  return orientation;
}

glm::dvec3 probe_in_scene_m(const render::Mesh& mesh_scene) {
  const render::Bounds box = render::bounds_of(mesh_scene);
  const bool is_origin_below = box.min_m.x <= 0 && box.max_m.x >= 0 && box.min_m.y <= 0 && box.max_m.y >= 0;
  const glm::dvec2 foot_m = is_origin_below ? glm::dvec2(0) : glm::dvec2(box.middle_m());
  return {foot_m, std::max(box.max_m.z, 0.0f) / 2};
}

}  // namespace catchlight::app
