// Reflection maps: the whole HDR probe as a cube map, prefiltered for roughness (split-sum, Karis 2013).
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "catchlight/image.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::render {

/// levels[k] holds six square faces stacked (+x -x +y -y +z -z, OpenGL's cube orientation) for perceptual roughness k / (count -
/// 1), scene-linear radiance in the TAG frame. Level 0 is the probe itself.
struct ReflectionMap {
  std::vector<Image> levels;
};

/// `face_size` is rounded up to a power of two from 64; 0: enough for the probe's own resolution, at most 512. 6 to 8 levels.
/// Multithreaded and deterministic.
ReflectionMap prefilter_reflections(const Probe& probe, const glm::dmat3& tag_from_probe, int face_size = 0);

/// Scale and bias of F0 by (n.v, perceptual roughness) for GGX with height-correlated Smith: size x size, 2 channels, texel
/// centres at (i + 0.5) / size.
Image environment_brdf_table(int size);

}  // namespace catchlight::render
