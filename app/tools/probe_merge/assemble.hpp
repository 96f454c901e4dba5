// Several photographs of one mirror ball, laid together to one probe.
#pragma once

#include <vector>

#include "app/tools/probe_merge/ball.hpp"
#include "app/tools/probe_merge/radiance_map.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::app {

struct BallPicture {
  RadianceMap radiance;
  BallView ball;
  glm::dmat3 probe_from_camera;
  double gain = 1;  ///< what its radiance is multiplied with
};

struct AssembledProbe {
  render::Probe probe;            ///< latlong
  double blind_share = 0;         ///< share of all directions that the ball hides in every view; filled from its rim
  double photographer_share = 0;  ///< share of all directions that are seen only around a camera's own reflection
  double clipped_sr = 0;          ///< solid angle of what is only known to be at least as bright as written
  double clipped_light = 0;       ///< its share of all light (luminance · sr), at least
};

/// What a view's sight of a direction is worth. It falls to 0 at the rim, where a pixel covers many directions, and within
/// `photographer_rad` of the camera, rising to the full at twice that. Never 0: what no other view shows is taken as it is.
double sight_weight(const BallSight& sight, double photographer_rad);

/// How much brighter `reference` is than `other`: the median ratio of luminance over what both see well, 1 where that is nothing.
double gain_between(const BallPicture& reference, const BallPicture& other, double photographer_rad);

/// Each texel is the mean of 2 x 2 directions, each the weighted mean of the views. `width` in texels.
AssembledProbe assemble_probe(const std::vector<BallPicture>& views, int width, double photographer_rad);

}  // namespace catchlight::app
