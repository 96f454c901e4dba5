// A small studio with a ball in it, for whole pictures.
#pragma once

#include "render/frame_view.hpp"
#include "render/render_scene.hpp"

namespace catchlight::render::test {

/// Radiance from a direction: a sky bright at the top, a small warm lamp in front on the left, dark below.
glm::vec3 studio(const glm::dvec3& direction);

ShRgb studio_light(int bands);

/// A ball of 5 cm radius on the tag, in the studio.
RenderScene ball(const Material& material);

Material material_of(const glm::vec3& color, float metallic, float roughness, float f0);

/// 200 x 150 pixels, from in front of the tag and above it.
FrameView tilted_view();

/// Codes of a plate, of 255: a chequered table.
glm::ivec3 table(int x, int y);

}  // namespace catchlight::render::test
