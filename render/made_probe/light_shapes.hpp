// The light of the probes that are made by name, by direction in the probe frame.
#pragma once

#include <glm/glm.hpp>

#include "render/probe/probe.hpp"

namespace catchlight::render {

/// CIE's overcast sky, of luminance 1 in the zenith and a third of that at the horizon.
double overcast_radiance(const glm::dvec3& direction);

/// Three softboxes in a dark room.
double studio_radiance(const glm::dvec3& direction);

/// Adds a disc of `diameter_deg` that brings `irradiance` (of a surface that faces it), whatever its edge does to the texels.
void add_disc(Probe& probe, const glm::dvec3& towards, double diameter_deg, const glm::dvec3& irradiance);

}  // namespace catchlight::render
