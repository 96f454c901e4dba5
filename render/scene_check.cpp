#include "render/scene_check.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw Error("cannot render: " + what);
}

void require_count(std::size_t actual, std::size_t expected, const std::string& what) {
  require(actual == expected, what + ": expected " + std::to_string(expected) + ", got " + std::to_string(actual));
}

template <typename T>
bool finite(const T& values, int count) {
  return std::all_of(&values[0], &values[0] + count, [](auto value) { return std::isfinite(value); });
}

bool finite(const glm::dmat3& m) {
  return finite(m[0], 3) && finite(m[1], 3) && finite(m[2], 3);
}
bool finite(const glm::mat3& m) {
  return finite(m[0], 3) && finite(m[1], 3) && finite(m[2], 3);
}

}  // namespace

void check_cubes(const ReflectionMap& map) {
  constexpr int kFaces = 6;
  for (const Image& level : map.levels)
    require(level.channels == 3 && level.width > 0 && level.height == kFaces * level.width,
            "a reflection level is " + std::to_string(level.width) + " x " + std::to_string(level.height) + " with " +
                std::to_string(level.channels) + " channels; six square RGB faces, one below the other, are needed");
}

const RenderScene& checked(const RenderScene& scene) {
  const Mesh& mesh = scene.mesh;
  const Transfer& transfer = scene.transfer;
  require(transfer.bands >= 1 && transfer.bands <= kMaxShBands,
          "the transfer has " + std::to_string(transfer.bands) + " bands, 1 to " + std::to_string(kMaxShBands) + " are possible");
  static_assert(sh_count(kMaxShBands) <= MAX_LIGHT_COEFFICIENTS);
  const auto coefficients = static_cast<std::size_t>(sh_count(transfer.bands));
  require_count(scene.light.size(), coefficients, "light coefficients for the transfer's bands");
  require_count(transfer.object.size(), mesh.vertices.size() * coefficients, "transfer coefficients for the mesh's vertices");
  require_count(mesh.indices.size(), 3 * mesh.triangle_material.size(), "indices for the mesh's triangles");
  require(std::ranges::all_of(mesh.indices, [&](auto i) { return i < mesh.vertices.size(); }),
          "a triangle's index is beyond the vertices");
  require(std::ranges::all_of(mesh.triangle_material, [&](auto m) { return m < mesh.materials.size(); }),
          "a triangle's material is beyond the materials");
  require(std::ranges::all_of(mesh.vertices, [](const Vertex& v) { return finite(v.position_m, 3); }),
          "a vertex position is not finite");
  static_assert(kMaxLightSamples <= MAX_LIGHT_SAMPLES);
  require(scene.lights.size() <= kMaxLightSamples,
          std::to_string(scene.lights.size()) + " light samples, at most " + std::to_string(kMaxLightSamples) + " are possible");
  for (const LightSample& light : scene.lights)
    require(finite(light.direction, 3) && finite(light.irradiance, 3), "a light is not finite");
  if (!scene.lights.empty())
    require_count(transfer.object_direct.size(), transfer.object.size(), "direct transfer coefficients for the mesh's vertices");
  check_cubes(scene.reflections);
  check_cubes(scene.rest_reflections);
  const ReceiverGrid& grid = transfer.grid;
  if (grid.columns < 2 || grid.rows < 2) return scene;
  require_count(transfer.receiver.size(),
                static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows) * coefficients,
                "transfer coefficients for the receiver's points");
  if (!scene.lights.empty())
    require_count(transfer.receiver_direct.size(), transfer.receiver.size(),
                  "direct transfer coefficients for the receiver's points");
  require_count(transfer.receiver_unshadowed.size(), coefficients, "unshadowed receiver coefficients");
  require(finite(grid.min_m, 2) && finite(grid.max_m, 2), "the receiver's corners are not finite");
  return scene;
}

void check_view(const FrameView& view) {
  const CameraModel& camera = view.camera;
  require(camera.width_px > 0 && camera.height_px > 0,
          "the camera's picture is " + std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px) + " pixels");
  require(camera.fx_px > 0 && camera.fy_px > 0 && std::isfinite(camera.fx_px + camera.fy_px + camera.cx_px + camera.cy_px),
          "the camera's focal lengths must be positive and its centre finite");
  require(std::ranges::all_of(camera.distortion, [](double k) { return std::isfinite(k); }),
          "a lens distortion coefficient is not finite");
  require(finite(view.camera_from_tag.rotation) && finite(view.camera_from_tag.translation_m, 3), "the pose is not finite");
  require(finite(view.tag_from_light), "the light's rotation is not finite");
  require(finite(view.exposure, 3) && finite(view.black, 3), "exposure or black level is not finite");
  require(finite(view.color.plate_from_rec709), "the plate's primaries are not finite");
}

}  // namespace catchlight::render
