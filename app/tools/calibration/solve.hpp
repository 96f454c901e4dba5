// The camera that explains many views of a board, and how well they determine it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/tools/calibration/board.hpp"
#include "catchlight/camera.hpp"

namespace catchlight::app {

/// Each has the coefficients of those before it and more.
enum class LensModel {
  plain,     ///< none
  radial,    ///< k1
  four,      ///< k1 k2 p1 p2
  standard,  ///< k1 k2 p1 p2 k3
  rational   ///< k1 k2 p1 p2 k3 k4 k5 k6
};

/// How many of CameraModel::distortion the model uses.
int coefficient_count(LensModel model);

struct ViewFit {
  BoardView view;
  std::vector<glm::dvec2> residuals_px;  ///< seen minus projected
  double rms_px = 0;                     ///< rms of the residuals' lengths
  double tilt_deg = 0;                   ///< between the board's normal and the camera's axis
};

struct RejectedView {
  std::int64_t frame = 0;
  double rms_px = 0;
};

struct Calibration {
  CameraModel camera;
  CameraModel deviation;  ///< standard deviation of each of the camera's parameters, where the noise is as in the residuals
  LensModel lens = LensModel::plain;
  double rms_px = 0;  ///< over all used points, of the residuals' lengths
  std::vector<ViewFit> views;
  std::vector<RejectedView> rejected;  ///< views more than three times as far off as the middle one
};

/// Zhang's method (2000) as OpenCV has it. Of the models up to `most`, the one of least Bayesian information criterion
/// (Schwarz 1978): a coefficient that the views do not determine stays 0.
/// Throws Error: fewer than 4 usable views; views that do not determine the focal length, as all are frontal.
Calibration solve_camera(std::vector<BoardView> views, int width_px, int height_px, LensModel most);

}  // namespace catchlight::app
