#include "render/probe/probe_lights.hpp"

namespace catchlight::render {
namespace {

// Raise when the prefilter, the split or their members change: older files then no longer match.
constexpr std::uint32_t kVersion = 4;

void archive_map(CacheStream& file, ReflectionMap& map) {
  file.for_each(map.levels, [&](Image& level) {
    file(level.width);
    file(level.height);
    file(level.channels);
    file(level.data);
  });
}

void archive_lights(CacheStream& file, ProbeLights& lights) {
  file(lights.harmonics);
  file.for_each(lights.samples, [&](LightSample& sample) {
    file(sample.direction);
    file(sample.irradiance);
    file(sample.spread_rad);
    file(sample.compact);
  });
  file.for_each(lights.lights, [&](LightSummary& light) {
    file(light.direction);
    file(light.irradiance);
    file(light.share);
    file(light.samples);
  });
  archive_map(file, lights.rest_reflections);
}

ContentHash hash_of(const std::string& probe_key, const glm::dmat3& rotation) {
  ContentHash hash;
  hash.add(kVersion);
  hash.add_bytes(probe_key.data(), probe_key.size());
  hash.add(rotation);
  return hash;
}

ProbeLights lights_of(const Probe& probe, const glm::dmat3& rotation, const SplitOptions& options) {
  ProbeLights result;
  result.harmonics = rotate_sh(project_to_sh(probe, options.bands), rotation);
  const SplitProbe split = split_lights(probe, options);
  result.samples = samples_of(split, rotation);
  for (const ProbeLight& light : split.lights)
    result.lights.push_back({rotation * light.direction, light.irradiance, light.share / kAverageSurfaces,
                             static_cast<std::uint32_t>(light.samples.size())});
  if (!result.samples.empty()) result.rest_reflections = prefilter_reflections(split.mirrored, rotation);
  return result;
}

}  // namespace

std::string content_key(const Probe& probe) {
  ContentHash hash;
  hash.add(static_cast<std::uint32_t>(probe.layout));
  hash.add(probe.image.width);
  hash.add(probe.image.data);
  return hash.text();
}

ReflectionMap load_or_prefilter(const Probe& probe, const std::string& probe_key, const glm::dmat3& rotation,
                                const ContentCache& cache, const WarningHandler& warn) {
  const auto make = [&] { return prefilter_reflections(probe, rotation); };
  return cache.get<ReflectionMap>("reflections", hash_of(probe_key, rotation).text(), warn, make, archive_map);
}

ProbeLights load_or_split(const Probe& probe, const std::string& probe_key, const glm::dmat3& rotation,
                          const SplitOptions& options, const ContentCache& cache, const WarningHandler& warn) {
  ContentHash hash = hash_of(probe_key, rotation);
  hash.add(options.bands);
  hash.add(options.tolerance);
  hash.add(options.max_samples);
  return cache.get<ProbeLights>(
      "lights", hash.text(), warn, [&] { return lights_of(probe, rotation, options); }, archive_lights);
}

}  // namespace catchlight::render
