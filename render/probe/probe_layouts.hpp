// Geometry that the layouts share inside the probe code: faces of a cube, discs.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "render/probe/probe.hpp"

namespace catchlight::render {

/// A face of the cube [-1, 1]^3 in an image: face position (s, t), s right and t down in [-1, 1], is direction centre + s right +
/// t down.
struct CubeFace {
  glm::dvec3 centre, right, down;
  int column, row;  ///< place in the image, in faces
};

/// Order +x -x +y -y +z -z.
using CubeFaces = std::array<CubeFace, 6>;

/// OpenGL's orientation (OpenGL 4.5 core, table 8.19), stacked.
const CubeFaces& gl_cube_faces();

/// The faces of ProbeLayout::cube or cube_cross.
const CubeFaces& faces_of(ProbeLayout layout);

inline bool is_cube(ProbeLayout layout) {
  return layout == ProbeLayout::cube || layout == ProbeLayout::cube_cross;
}
inline bool is_disc(ProbeLayout layout) {
  return layout == ProbeLayout::angular || layout == ProbeLayout::mirror_ball;
}

/// Side of a face in texels.
inline int face_size(ProbeLayout layout, int width) {
  return layout == ProbeLayout::cube ? width : width / 3;
}

/// Index of the face that `direction` goes through; on an edge the earlier one, as OpenEXR chooses.
int face_of(const CubeFaces& faces, const glm::dvec3& direction);

/// (s, t) of `direction` on the face's plane.
glm::dvec2 position_on_face(const CubeFace& face, const glm::dvec3& direction);

/// Texel coordinate <-> face coordinate: OpenEXR's cube has texel centres on the face's edges, the cross has texel borders there.
inline double texel_from_face(ProbeLayout layout, int size, double s) {
  return layout == ProbeLayout::cube ? (s + 1) / 2 * (size - 1) : (s + 1) / 2 * size - 0.5;
}
inline double face_from_texel(ProbeLayout layout, int size, double x) {
  return layout == ProbeLayout::cube ? 2 * x / (size - 1) - 1 : (2 * x + 1) / size - 1;
}

/// Disc layouts: texel (x, y) itself if its centre is in the unit disc, else the nearest such texel towards the middle, which
/// stands for it in filters and in solid angles.
glm::ivec2 nearest_disc_texel(int width, int height, int x, int y);

/// Texels that look in one direction (a pole's row, both columns of +-180 degrees, borders of OpenEXR's cube faces) get their
/// mean, weighted by solid angle: no seam can show and no light is lost.
void weld_seams(Probe& probe);

/// Throws Error (starting with `what`) where the layout cannot have this shape: too small, too large, wrong proportions.
void check_probe_shape(ProbeLayout layout, int width, int height, const std::string& what);

}  // namespace catchlight::render
