// The response of the camera that took a bracket: recovered from it, or known.
#pragma once

#include <array>
#include <vector>

#include "app/tools/probe_merge/photographs.hpp"
#include "catchlight/response.hpp"

namespace catchlight::app {

/// Light (radiance · exposure) of each code, per channel, red first; never falling.
using LightOfCodes = std::array<std::vector<double>, 3>;

/// sRGB or linear, light 1 at the highest code.
LightOfCodes known_response(TransferFunction transfer, int max_code);

/// Debevec & Malik 1997: the logarithm g of light by code makes g(code) - log(exposure) one number for each pixel in all
/// photographs. Equal steps of exposure leave g open by anything that repeats with the step (Grossberg & Nayar 2003), and 256
/// free values take it up; so g is a sum of sRGB's, a power law's and four powers of the code, by linear least squares. Light 1
/// at code 128 in each channel: the camera's white balance stays. 8 bits, at least two photographs. Throws Error where they do
/// not agree on one response.
LightOfCodes recover_response(const Bracket& bracket);

}  // namespace catchlight::app
