// Figures that tell whether a probe is what its owner thinks it is.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/probe/probe.hpp"

namespace catchlight::app {

/// Luminances are of scene-linear radiance by Rec. 709's weights; means are over solid angle; directions are in the probe frame
/// (+y up).
struct ProbeStatistics {
  double max = 0;
  double min_lit = 0;  ///< least luminance above 0; 0 where all is black
  double mean = 0;
  double log_average = 0;  ///< exp(mean of log(1e-6 max + L)) (Reinhard 2002): finite with black texels
  double range_ev = 0;     ///< log2(max / min_lit)
  glm::dvec3 brightest{0.0};
  glm::dvec3 irradiance_up{0.0}, irradiance_down{0.0};  ///< on level surfaces that face up and down
  std::vector<double> band_energy;                      ///< sum over m of the squared coefficients of luminance, l = 0 ...
  double energy = 0;                                    ///< integral of the squared luminance: what all bands together would hold
};

ProbeStatistics measure_probe(const render::Probe& probe, int bands);

}  // namespace catchlight::app
