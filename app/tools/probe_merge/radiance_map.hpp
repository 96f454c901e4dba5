// From a bracket's codes to scene-linear radiance.
#pragma once

#include <cstdint>
#include <vector>

#include "app/tools/probe_merge/photographs.hpp"
#include "app/tools/probe_merge/response_recovery.hpp"
#include "catchlight/image.hpp"

namespace catchlight::app {

/// Scene-linear radiance of a view, with what is not known of it.
struct RadianceMap {
  Image image;                        ///< 3 channels, finite, >= 0
  std::vector<std::uint8_t> clipped;  ///< per pixel: at least as bright as this, in some channel
  double clipped_share = 0;           ///< share of the pixels that are clipped
};

/// Each code tells radiance with the error of its own step: light' / exposure. Weights are the inverse squares of that, so that
/// the longest exposure that is not clipped decides, times a window that fades codes out below 4 % and above 90 %, so that no
/// exposure ends at a visible edge. What is clipped in every photograph keeps the shortest one's lower bound and is marked.
RadianceMap merge_bracket(const Bracket& bracket, const LightOfCodes& response);

/// The radiance of a linear picture, in which nothing is clipped; bad pixels become 0.
RadianceMap radiance_of(Image image);

}  // namespace catchlight::app
