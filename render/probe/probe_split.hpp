// A light probe divided into a few lights and a smooth rest: what is far brighter than its surroundings throws sharp shadows,
// which no handful of spherical harmonics can hold; what is left needs only a few.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/probe/light_samples.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::render {

/// One light of the place: a lamp, a window, the sun.
struct ProbeLight {
  glm::dvec3 direction;   ///< towards the light, length 1: the middle of its flux
  glm::dvec3 irradiance;  ///< sum over the samples
  double solid_angle_sr = 0;
  bool compact = false;  ///< no sample is wider than kCompactSpread_rad: together they draw the light's shape on a rough surface
  double share = 0;      ///< what a surface facing it would lose in its shadow, of an average surface's luminance; may exceed 1
  std::vector<LightSample> samples;
};

struct SplitProbe {
  std::vector<ProbeLight> lights;  ///< brightest first
  Probe rest;                      ///< same layout; lights and rest add up to the probe texel by texel
  Probe mirrored;                  ///< the probe less the compact lights alone, for rough mirrors that add those as highlights
  double threshold = 0;            ///< luminance that the rest was cut down to where a light was
};

struct SplitOptions {
  int bands = 5;             ///< bands that the rest will be projected to: light that these hold well is not split off
  double tolerance = 0.004;  ///< visible error allowed, as a share of white
  int max_samples = 96;      ///< samples of all lights together, at most; 0: no lights
};

/// All the probe's light is this many times what an average surface gets of it: ProbeLight::share over this is the light's share
/// of the whole.
inline constexpr double kAverageSurfaces = 4;

/// What is brighter than kLightContrast times the mean of what the split leaves is a light (a fixed point; suns hide no lamps).
/// Peaks are told apart by watershed (light_clusters.hpp), and split off only where a shadow of the light that the bands cannot
/// hold would be visible. A black probe, or one without contrast, has no lights.
inline constexpr double kLightContrast = 5;
inline constexpr double kCompactSpread_rad = 0.07;  // about what GGX of roughness 0.25 blurs
SplitProbe split_lights(const Probe& probe, const SplitOptions& options);

/// All samples, brightest light first, in the frame that `rotation` takes the probe's to.
std::vector<LightSample> samples_of(const SplitProbe& split, const glm::dmat3& rotation);

}  // namespace catchlight::render
