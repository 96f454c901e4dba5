// Layouts of light probes and their geometry: texels and directions, faces of a cube, discs.
//
// The probe frame is +y up; in latlong (OpenEXR's ImfEnvmap.h) longitude 0 is +z in the middle column, +90 deg is +x, left of it.
// Longitude is +180 deg at the left edge's pixel centres and -180 deg at the right edge's: outermost pixel centres lie on +-180
// and +-90 deg.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "catchlight/util/enum_names.hpp"

namespace catchlight::render {

/// OpenEXR's layouts have their outermost texel centres on +-180 degrees, the poles and the cube's edges; the others have texel
/// borders there.
enum class ProbeLayout {
  latlong,         ///< ImfEnvmap.h, as above
  angular,         ///< Debevec's light probe: u = Dx r, v = Dy r, r = acos(Dz) / (pi sqrt(Dx^2 + Dy^2)); +z in the middle, +y up
  mirror_ball,     ///< orthographic photograph of a mirror sphere, the camera at +z: the middle reflects +z
  cube_cross,      ///< HDRShop's and cmft's 3 x 4 faces, OpenGL's orientation: +y; -x +z +x; -y; -z turned by half a turn
  cube,            ///< ImfEnvmap.h: faces stacked +x -x +y -y +z -z
  angular_inside,  ///< as a camera inside sees it that looks along -z: angular with -Dz for Dz; -z in the middle, +x right of it
};
constexpr auto names_of(ProbeLayout) {
  return std::array{"latlong", "angular", "mirror-ball", "cube-cross", "cube", "angular-inside"};
}

/// Throws Error naming the layouts there are for anything else.
ProbeLayout probe_layout_from_name(const std::string& name);

/// Probe-frame direction (length 1) of image position (x, y) in texels, texel centres at integers; empty outside the layout's
/// valid area.
std::optional<glm::dvec3> direction_from_texel(ProbeLayout layout, int width, int height, double x, double y);

/// The inverse of direction_from_texel; finite for every direction, the poles and -z of the angular map included.
glm::dvec2 texel_from_direction(ProbeLayout layout, int width, int height, const glm::dvec3& direction);

/// Exact solid angle (sr) of texel (x, y), 0 outside the layout's valid area; they sum to 4 pi (mirror ball: less by its blind
/// spot's rounding).
double texel_solid_angle(ProbeLayout layout, int width, int height, int x, int y);

/// A face of the cube [-1, 1]^3 in an image: face position (s, t), s right and t down in [-1, 1], is direction centre + s right +
/// t down.
struct CubeFace {
  glm::dvec3 centre, right, down;
  int column, row;  ///< place in the image, in faces
};

/// The six faces in the order +x -x +y -y +z -z.
using CubeFaces = std::array<CubeFace, 6>;

/// The faces in OpenGL's orientation (OpenGL 4.5 core, table 8.19), stacked.
const CubeFaces& gl_cube_faces();

/// The faces of ProbeLayout::cube or cube_cross.
const CubeFaces& faces_of(ProbeLayout layout);
inline bool is_disc(ProbeLayout layout) {
  return layout == ProbeLayout::angular || layout == ProbeLayout::mirror_ball || layout == ProbeLayout::angular_inside;
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

/// Throws Error (starting with `what`) where the layout cannot have this shape: too small, too large, wrong proportions.
void check_probe_shape(ProbeLayout layout, int width, int height, const std::string& what);

}  // namespace catchlight::render
