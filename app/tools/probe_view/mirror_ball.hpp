// A probe as a mirror ball shows it.
#pragma once

#include <glm/glm.hpp>

#include "catchlight/image.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::app {

/// A mirror ball seen by a far camera. `probe_from_ball` takes the camera's axes (x right, y away from it, z up) to the probe's:
/// the middle mirrors the camera, the rim what is behind the ball. Each pixel is the mean of samples_across^2. RGBA,
/// scene-linear, premultiplied.
Image mirror_ball(const render::Probe& probe, const glm::dmat3& probe_from_ball, int size_px, int samples_across);

/// The place on such a ball, from the middle in radii (x right, y up), that mirrors `direction`, of length 1 and in the camera's
/// axes as above.
glm::dvec2 place_on_ball(const glm::dvec3& direction);

/// The ball on the tag, seen horizontally from tag -y: right is tag +x, up is tag +z. For a probe with up = "z".
Image mirror_ball_preview(const render::Probe& probe, double yaw_deg, int size_px);

}  // namespace catchlight::app
