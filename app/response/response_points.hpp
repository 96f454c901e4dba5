// Response curves as files hold them, and what makes a curve of them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "catchlight/error.hpp"
#include "catchlight/response.hpp"

namespace catchlight::app {

/// Light (red first) at rising codes.
struct ResponsePoints {
  std::vector<double> codes;  ///< 0 to 1
  std::array<std::vector<double>, 3> light;
  bool is_measured = true;  ///< any scale, with noise; else light 1 is reference white
};

/// `text` is the file's; `path` is for messages. They throw Error "FILE[:LINE]: ..." where it is not of its kind.
ResponsePoints points_of_storage(const std::string& path, const std::string& text);
ResponsePoints points_of_csv(const std::string& path, const std::string& text);
ResponsePoints points_of_cube(const std::string& path, const std::string& text);

/// Mends, scales, and resamples unless the points are evenly spaced from 0 to 1; see load_response().
ResponseCurve curve_of(ResponsePoints points, const std::string& path, const WarningHandler& warn);

/// The nearest sequence that never falls, by least squares (pool adjacent violators; Barlow et al. 1972).
std::vector<double> isotonic(const std::vector<double>& values);

}  // namespace catchlight::app
