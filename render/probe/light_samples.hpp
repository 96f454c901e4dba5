// A light cut into samples of equal luminance.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/math/sh.hpp"

namespace catchlight::render {

/// A part of a light small enough to count as one direction: what one shadow map is drawn for.
struct LightSample {
  glm::dvec3 direction;   ///< towards the light, length 1: the middle of its flux
  glm::dvec3 irradiance;  ///< irradiance on a surface that faces it: the integral of radiance over its solid angle
  double spread_rad = 0;  ///< root mean square angle of its light from `direction`, along one axis
  bool compact = true;    ///< part of a lamp rather than of the sky: a highlight on rough surfaces
};

/// A piece of a light as the probe's texels give it.
struct LightPiece {
  glm::dvec3 direction;
  glm::dvec3 irradiance;
  double solid_angle_sr;
};

/// At most `count` samples that add up to the pieces: median cut (Debevec, "A Median Cut Algorithm for Light Probe Sampling",
/// SIGGRAPH 2005 posters) along the longer side of each region. Needs a piece; the order of the pieces is lost.
std::vector<LightSample> median_cut(std::vector<LightPiece> pieces, int count);

/// The samples' light as coefficients: sum of irradiance * y_i(direction).
ShRgb project_to_sh(std::span<const LightSample> samples, int bands);

}  // namespace catchlight::render
