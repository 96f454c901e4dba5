#include "app/media/write/layer_style.hpp"

#include <cmath>
#include <optional>

#include "catchlight/projection.hpp"

namespace catchlight::app {
namespace {

glm::dmat3 style_from_camera(const LayerOptions& options, const RigidTransform& camera_from_tag) {
  switch (options.style) {
    case LayerStyle::nuke:
      return glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
    case LayerStyle::blender: {
      const glm::dmat3 z_up_from_y_up(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0));
      return z_up_from_y_up * options.world_from_tag * glm::transpose(camera_from_tag.rotation);
    }
    case LayerStyle::plain:
      break;
  }
  return glm::dmat3(1.0);
}

/// The point that a pixel shows.
std::optional<glm::dvec3> point_at(const CameraModel& camera, const glm::dvec2& px, double depth_m) {
  const auto ideal_px = undistort_px(camera, px);
  if (!ideal_px) return {};
  return glm::dvec3((ideal_px->x - camera.cx_px) / camera.fx_px, (ideal_px->y - camera.cy_px) / camera.fy_px, 1.0) * depth_m;
}

}  // namespace

Image styled_normals(const Image& normals, const LayerOptions& options, const RigidTransform& camera_from_tag) {
  const glm::mat3 turn(style_from_camera(options, camera_from_tag));
  Image turned = normals;
  for (std::size_t i = 0; i < turned.data.size(); i += 3) {
    const glm::vec3 normal = turn * glm::vec3(turned.data[i], turned.data[i + 1], turned.data[i + 2]);
    for (int c = 0; c < 3; ++c) turned.data[i + static_cast<std::size_t>(c)] = normal[c];
  }
  return turned;
}

Image offset_px(const Image& depth, const CameraModel& camera, const RigidTransform& camera_from_tag,
                const RigidTransform& other_camera_from_tag) {
  const RigidTransform other_from_camera = other_camera_from_tag * inverse(camera_from_tag);
  Image offset(depth.width, depth.height, 2);
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width) + static_cast<std::size_t>(x);
      if (!std::isfinite(depth.data[at])) continue;
      const auto point_m = point_at(camera, {x, y}, depth.data[at]);
      const auto there_px = point_m ? project_px(camera, other_from_camera * *point_m) : std::nullopt;
      if (!there_px) continue;
      offset.data[2 * at] = static_cast<float>(there_px->x - x);
      offset.data[2 * at + 1] = static_cast<float>(y - there_px->y);
    }
  }
  return offset;
}

std::vector<MotionLayer> motion_layers(LayerStyle style, const Image& backward_px, const Image& forward_px) {
  if (style == LayerStyle::plain) return {};
  if (style == LayerStyle::nuke) return {{"forward", {"u", "v"}, forward_px}, {"backward", {"u", "v"}, backward_px}};
  Image vector(backward_px.width, backward_px.height, 4);
  for (std::size_t i = 0; i < vector.data.size() / 4; ++i) {
    for (std::size_t c = 0; c < 2; ++c) {
      vector.data[4 * i + c] = backward_px.data[2 * i + c];
      vector.data[4 * i + 2 + c] = -forward_px.data[2 * i + c];
    }
  }
  return {{"Vector", {"X", "Y", "Z", "W"}, std::move(vector)}};
}

}  // namespace catchlight::app
