// A light probe as the renderer takes it, kept in the cache.
#pragma once

#include <string>
#include <vector>

#include "catchlight/error.hpp"
#include "render/cache/content_cache.hpp"
#include "render/probe/light_samples.hpp"
#include "render/probe/prefilter.hpp"
#include "render/probe/probe.hpp"
#include "render/probe/probe_split.hpp"

namespace catchlight::render {

/// A light that was split off, without its shape.
struct LightSummary {
  glm::dvec3 direction;       ///< towards it, length 1
  glm::dvec3 irradiance;      ///< on a surface that faces it
  double share = 0;           ///< of all the probe's light
  std::uint32_t samples = 0;  ///< how many of the samples are of it
};

/// What the probe is taken apart into, in the frame that it is turned to.
struct ProbeLights {
  ShRgb harmonics;                   ///< of the whole probe
  std::vector<LightSample> samples;  ///< brightest light first
  std::vector<LightSummary> lights;  ///< that the samples are of, in their order
  ReflectionMap rest_reflections;    ///< the probe less its compact lights; empty where there are no samples
};

/// A hash of the probe's texels and layout.
std::string content_key(const Probe& probe);

/// prefilter_reflections(probe, rotation) behind a cache. `probe_key`: content_key(probe).
ReflectionMap load_or_prefilter(const Probe& probe, const std::string& probe_key, const glm::dmat3& rotation,
                                const ContentCache& cache, const WarningHandler& warn);

/// The probe's lights behind a cache, for a light of options.bands bands.
ProbeLights load_or_split(const Probe& probe, const std::string& probe_key, const glm::dmat3& rotation,
                          const SplitOptions& options, const ContentCache& cache, const WarningHandler& warn);

}  // namespace catchlight::render
