// Light probes: images of scene-linear radiance over all directions, in the layouts users have.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/util/enum_names.hpp"
#include "render/math/sh.hpp"
#include "render/probe/probe_layouts.hpp"
#include "render/probe/texel_rows.hpp"

namespace catchlight::render {

struct Probe {
  Image image;  ///< 3 channels, finite and >= 0 after load_probe
  ProbeLayout layout = ProbeLayout::latlong;
};

/// Bilinear radiance in `direction`, continuous across the layout's seams.
glm::vec3 sample(const Probe& probe, const glm::dvec3& direction);

/// The same for many directions, of any length.
void sample(const Probe& probe, const Coordinates3& directions, std::span<glm::vec3> radiance);

/// The same light in another layout, averaged over each texel. `width` 0 keeps the angular resolution at the equator.
Probe convert(const Probe& probe, ProbeLayout layout, int width = 0);

/// The same place in a mirror: x and -x exchanged, texel by texel.
Probe mirrored(const Probe& probe);

/// Texels that look in one direction (a pole's row, both columns of +-180 degrees, borders of OpenEXR's cube faces) get their
/// mean, weighted by solid angle: no seam can show and no light is lost.
void weld_seams(Probe& probe);

struct ProbeLoadOptions {
  std::optional<ProbeLayout> layout;  ///< empty: as save_probe noted, else the file's envmap attribute, else by shape (2:1
                                      ///< latlong, 3:4, 4:3 and 6:1 cube-cross, 1:6 cube), else an error
  bool strict = false;                ///< refuse NaN, infinite or negative texels instead of treating them as 0
};

/// Reads OpenEXR or Radiance HDR. A cross that lies (4:3) and a row of OpenGL's faces (6:1) become a cube-cross. Warns once with
/// count and first position of bad texels. Texels that look in one direction (seams, poles) get their common mean. Throws Error
/// (file named) otherwise.
Probe load_probe(const std::string& path, const ProbeLoadOptions& options, const WarningHandler& warn);

enum class ExrPrecision {
  enough,  ///< half, or float where a value exceeds 65504
  full     ///< float
};

/// Writes OpenEXR (with the envmap attribute where OpenEXR knows the layout) or Radiance HDR (of its own precision), by
/// extension. The file says the layout, for load_probe.
void save_probe(const std::string& path, const Probe& probe, ExrPrecision precision = ExrPrecision::enough);

/// c_i = sum of radiance * y_i * solid angle over all texels; no sampling noise.
ShRgb project_to_sh(const Probe& probe, int bands);

/// The tag axis that points up in the world.
enum class UpAxis {
  z,  ///< tag on a table: probe +y = tag +z, +z = tag -y, +x = tag +x
  y   ///< tag on a wall: the axes agree
};
constexpr auto names_of(UpAxis) {
  return std::array{"z", "y"};
}

/// The rotation that takes probe directions to tag directions: the axes as `up` says, then yaw about up.
glm::dmat3 tag_from_probe(UpAxis up, double yaw_deg);

/// Irradiance (W-like units, integral of radiance * cos) on a surface with `normal_probe`, summed exactly over the texels above
/// it.
glm::dvec3 irradiance(const Probe& probe, const glm::dvec3& normal_probe);

}  // namespace catchlight::render
