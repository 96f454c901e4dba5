// The camera's response by name or from a file, where the footage does not say it, or says it wrongly.
#pragma once

#include <optional>
#include <string>

#include "catchlight/error.hpp"
#include "catchlight/response.hpp"

namespace catchlight::app {

/// What `exposure.response` names; empty for "footage": as the stream declares.
///   "srgb", "linear", "gamma:2.4"    by formula
///   .yaml, .yml, .xml                OpenCV FileStorage with one N x 1 matrix of 1 or 3 channels (blue first), or N x 3, such as
///                                    cv::createCalibrateDebevec and Robertson produce: light of each code, any scale
///   .csv                             rows of code, red, green, blue, rising in code; the highest code is 1, light has any scale
///   .cube                            1D LUT (Adobe): code to linear light, as is
/// Measured curves (all but .cube) are scaled to 1 at the highest code, each channel. Light has to rise with the code: dips of a
/// measured curve are mended by isotonic regression, with a warning, where that moves nothing by more than a twentieth of white.
/// Throws Error naming the file, where it is wrong and what to do.
std::optional<CameraResponse> load_response(const std::string& name, const WarningHandler& warn);

}  // namespace catchlight::app
