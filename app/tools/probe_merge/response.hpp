// From a bracket's codes to scene-linear radiance.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "app/tools/probe_merge/photographs.hpp"
#include "catchlight/image.hpp"
#include "catchlight/response.hpp"

namespace catchlight::app {

/// Light (radiance · exposure) of each code, per channel, red first; never falling.
using ResponseCurves = std::array<std::vector<double>, 3>;

/// sRGB or linear, light 1 at the highest code.
ResponseCurves known_response(TransferFunction transfer, int max_code);

/// Debevec & Malik 1997: the logarithm g of light by code makes g(code) - log(exposure) one number for each pixel in all
/// photographs. Equal steps of exposure leave g open by anything that repeats with the step (Grossberg & Nayar 2003), and 256
/// free values take it up; so g is a sum of sRGB's, a power law's and four powers of the code, by linear least squares. Light 1
/// at code 128 in each channel: the camera's white balance stays. 8 bits, at least two photographs. Throws Error where they do
/// not agree on one response.
ResponseCurves recover_response(const Bracket& bracket);

/// Scene-linear radiance of a view, with what is not known of it.
struct RadianceMap {
  Image image;                        ///< 3 channels, finite, >= 0
  std::vector<std::uint8_t> clipped;  ///< per pixel: at least as bright as this, in some channel
  double clipped_share = 0;           ///< of the pixels
};

/// Each code tells radiance with the error of its own step: light' / exposure. Weights are the inverse squares of that, so that
/// the longest exposure that is not clipped decides, times a window that fades codes out below 4 % and above 90 %, so that no
/// exposure ends at a visible edge. What is clipped in every photograph keeps the shortest one's lower bound and is marked.
RadianceMap merge_bracket(const Bracket& bracket, const ResponseCurves& response);

/// Of a linear picture: bad pixels become 0.
RadianceMap radiance_of(Image image);

}  // namespace catchlight::app
