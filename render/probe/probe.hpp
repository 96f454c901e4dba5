// Light probes: images of scene-linear radiance over all directions, in the layouts users have.
//
// The probe frame is +y up; in latlong (OpenEXR's ImfEnvmap.h) longitude 0 is +z in the middle column, +90 deg is +x, left of it.
// Longitude is +180 deg at the left edge's pixel centres and -180 deg at the right edge's: outermost pixel centres lie on +-180
// and +-90 deg.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/math/sh.hpp"

namespace catchlight::render {

/// OpenEXR's layouts have their outermost texel centres on +-180 degrees, the poles and the cube's edges; the others have texel
/// borders there.
enum class ProbeLayout {
  latlong,      ///< ImfEnvmap.h, as above
  angular,      ///< Debevec's light probe: u = Dx r, v = Dy r, r = acos(Dz) / (pi sqrt(Dx^2 + Dy^2)); +z in the middle, +y up
  mirror_ball,  ///< orthographic photograph of a mirror sphere, the camera at +z: the middle reflects +z
  cube_cross,   ///< HDRShop's and cmft's 3 x 4 faces, OpenGL's orientation: +y; -x +z +x; -y; -z turned by half a turn
  cube,         ///< ImfEnvmap.h: faces stacked +x -x +y -y +z -z
};

/// "latlong", "angular", "mirror-ball", "cube-cross", "cube"; throws Error naming them for anything else.
ProbeLayout probe_layout_from_name(const std::string& name);
std::string name_of(ProbeLayout layout);

struct Probe {
  Image image;  ///< 3 channels, finite and >= 0 after load_probe
  ProbeLayout layout = ProbeLayout::latlong;
};

/// Probe-frame direction (length 1) of image position (x, y) in texels, texel centres at integers; empty outside the layout's
/// valid area.
std::optional<glm::dvec3> direction_from_texel(ProbeLayout layout, int width, int height, double x, double y);

/// Inverse of direction_from_texel; finite for every direction, the poles and -z of the angular map included.
glm::dvec2 texel_from_direction(ProbeLayout layout, int width, int height, const glm::dvec3& direction);

/// Exact solid angle (sr) of texel (x, y), 0 outside the layout's valid area; they sum to 4 pi (mirror ball: less by its blind
/// spot's rounding).
double texel_solid_angle(ProbeLayout layout, int width, int height, int x, int y);

/// Bilinear radiance in `direction`, continuous across the layout's seams.
glm::vec3 sample(const Probe& probe, const glm::dvec3& direction);

/// Same light in another layout, averaged over each texel. `width` 0 keeps the angular resolution at the equator.
Probe convert(const Probe& probe, ProbeLayout layout, int width = 0);

struct ProbeLoadOptions {
  std::optional<ProbeLayout>
      layout;  ///< empty: the file's envmap attribute, else by shape (2:1 latlong, 3:4 cube-cross, 1:6 cube), else an error
  bool strict = false;  ///< refuse NaN, infinite or negative texels instead of treating them as 0
};

/// Reads OpenEXR or Radiance HDR. Warns once with count and first position of bad texels. Texels that look in one direction
/// (seams, poles) get their common mean. Throws Error (file named) otherwise.
Probe load_probe(const std::string& path, const ProbeLoadOptions& options, const WarningHandler& warn);

enum class ExrPrecision {
  enough,  ///< half, or float where a value exceeds 65504
  full     ///< float
};

/// Writes OpenEXR (with the envmap attribute where OpenEXR knows the layout) or Radiance HDR (of its own precision), by
/// extension.
void save_probe(const std::string& path, const Probe& probe, ExrPrecision precision = ExrPrecision::enough);

/// c_i = sum of radiance * y_i * solid angle over all texels; no sampling noise.
ShRgb project_to_sh(const Probe& probe, int bands);

/// Rotation that takes probe directions to tag directions. `up` is the tag axis that points up in the world: 'z' (tag on a table:
/// probe +y = tag +z, +z = tag -y, +x = tag +x) or 'y' (tag on a wall: axes agree); then yaw about up.
glm::dmat3 tag_from_probe(char up, double yaw_deg);

/// Irradiance (W-like units, integral of radiance * cos) on a surface with `normal_probe`, summed exactly over the texels above
/// it.
glm::dvec3 irradiance(const Probe& probe, const glm::dvec3& normal_probe);

}  // namespace catchlight::render
