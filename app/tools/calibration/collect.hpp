// Goes through footage and keeps few, sharp, well spread views of a board.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/media/frame_range.hpp"
#include "app/media/read/source.hpp"
#include "app/support/log.hpp"
#include "app/tools/calibration/board.hpp"

namespace catchlight::app {

/// A view with its frame, so that it can be measured again with a better camera model.
struct SeenBoard {
  BoardView view;
  Frame frame;
};

struct CollectedViews {
  std::vector<SeenBoard> boards;  ///< in the order of the footage
  int width_px = 0, height_px = 0;
  int frames_read = 0, frames_tried = 0, frames_with_board = 0;
  std::vector<std::int64_t> blurred;  ///< frames left out as more than twice as blurred as the middle one
  std::optional<std::string> damage;  ///< the footage broke off: what is known about it
};

/// Tries the sharpest frame of each stretch of footage, 150 stretches at most where the footage says how long it is. Of more
/// than 40 views, the blurrier of the two most alike goes, again and again: position, size, tilt and turn decide what is alike.
CollectedViews collect_views(MediaSource& source, CalibrationBoard& board, const FrameRange& range, Log& log);

}  // namespace catchlight::app
