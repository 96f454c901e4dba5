// What the receiving plane sends back of its light, as the light probe saw it from above.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "catchlight/image.hpp"
#include "render/cache/content_cache.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::render {

/// Diffuse albedo of the plane tag z = 0, by the direction in which a point lies from `seen_from_m`: rows from straight down to
/// the horizon, columns by angle about z from +x on. Without an image there is no such surface.
struct ReceiverAlbedo {
  glm::vec3 seen_from_m{0};
  Image image;

  bool known() const { return image.width > 0; }
  glm::vec3 at(const glm::vec2& place_m) const;
  /// The albedo of the point that lies in `direction` from seen_from_m.
  glm::vec3 towards(const glm::vec3& direction) const;
};

/// The same albedo everywhere.
ReceiverAlbedo constant_albedo(const glm::vec3& albedo);

/// pi L / E of every point below the probe, L being the radiance that the probe saw of it and E the probe's irradiance on the
/// plane. Empty where the plane sends up more than it gets (a screen, a light table) or gets nothing: what is below shines by
/// itself then. 1 where the probe saw more than the plane can send back (a lamp below the horizon).
std::optional<ReceiverAlbedo> albedo_from_probe(const Probe& probe, const glm::dmat3& tag_from_probe,
                                                const glm::vec3& probe_in_tag_m);

/// albedo_from_probe behind a cache. `probe_key`: content_key(probe).
std::optional<ReceiverAlbedo> load_or_find_albedo(const Probe& probe, const std::string& probe_key,
                                                  const glm::dmat3& tag_from_probe, const glm::vec3& probe_in_tag_m,
                                                  const ContentCache& cache, const WarningHandler& warn);

}  // namespace catchlight::render
