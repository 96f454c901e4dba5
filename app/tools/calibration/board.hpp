// Boards of known shape, found in pictures: what a calibration measures with.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/tools/tag_print/tag_grid.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"

namespace catchlight::app {

/// One frame's sight of the board.
struct BoardView {
  std::int64_t frame = 0;
  std::vector<glm::dvec2> points_board_m;  ///< in the board's plane
  std::vector<glm::dvec2> points_px;       ///< where each is seen (distorted)
  double blur_px = 0;                      ///< standard deviation of the blur across its edges
};

class CalibrationBoard {
 public:
  virtual ~CalibrationBoard() = default;

  /// Empty where the board, or too little of it, is seen. `camera` may be a guess; where it matters, a better one places points
  /// better: needs_camera().
  virtual std::optional<BoardView> find(const LumaView& luma, const CameraModel& camera) = 0;
  virtual bool needs_camera() const = 0;
};

/// The board whose points are where black and white squares meet: `inner_corners` columns and rows, at least 3 each.
/// (cv::findChessboardCornersSB: Duda & Frese 2018.)
std::unique_ptr<CalibrationBoard> make_checkerboard(const glm::ivec2& inner_corners, double square_m);

/// The corners of the grid's tags, each where its refined edges meet; at least four tags. Throws as tracking::Detector.
std::unique_ptr<CalibrationBoard> make_tag_board(const TagGrid& grid);

}  // namespace catchlight::app
