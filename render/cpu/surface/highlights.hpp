// The highlights of the lights that are split off, on rough surfaces.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/math/float4.hpp"
#include "render/probe/light_samples.hpp"

namespace catchlight::render {

/// A surface that shines: shading::glossy_brdf()'s arguments but for the light.
struct GlossySurface {
  glm::vec3 normal, to_viewer;  ///< of length 1
  float alpha;
  glm::vec3 f0;
  float f90;
};

class Highlights {
 public:
  /// Only compact samples make highlights.
  void set_samples(std::span<const LightSample> samples_tag);

  /// The sum over the samples of irradiance * share * BRDF. `shares`: how much of each sample is seen.
  glm::vec3 radiance(const GlossySurface& surface, const float* shares) const;

 private:
  // An array a member, so that the compiler works on several samples at once.
  std::vector<float> x_, y_, z_, spread2_;
  std::vector<Float4> irradiance_;
  std::vector<std::size_t> number_;  ///< among the samples
};

}  // namespace catchlight::render
