// Layers as other programs expect them.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::app {

enum class LayerStyle { plain, nuke, blender };

constexpr auto names_of(LayerStyle) {
  return std::array{"plain", "nuke", "blender"};
}

/// What layers hold besides the frame's light.
struct LayerOptions {
  LayerStyle style = LayerStyle::plain;
  CameraModel camera = {};
  glm::dmat3 world_from_tag{1.0};  ///< the world's +y is up
  std::string software = {};       ///< what wrote them
};

/// Normals (OpenCV's camera axes, 0 where nothing is) in the axes of the style. Nuke: the camera's, y up, z towards who looks.
/// Blender: its world's, z up.
Image styled_normals(const Image& normals, const LayerOptions& options, const RigidTransform& camera_from_tag);

/// Where what is seen at a pixel is seen from another pose, less that pixel: px, x to the right, y up; 2 channels. 0 where
/// `depth` (metres along z) is infinite, and what is not before the other camera.
Image offset_px(const Image& depth, const CameraModel& camera, const RigidTransform& camera_from_tag,
                const RigidTransform& other_camera_from_tag);

/// A layer that tells how the object moves.
struct MotionLayer {
  std::string name;
  std::vector<std::string> channels;
  Image image;
};

/// Nuke: `forward.u .v`, the offset to the next frame, and `backward.u .v`, to the one before. Blender: `Vector.X .Y`, the offset
/// to the frame before, and `.Z .W`, less the offset to the next. None for plain layers.
std::vector<MotionLayer> motion_layers(LayerStyle style, const Image& backward_px, const Image& forward_px);

}  // namespace catchlight::app
