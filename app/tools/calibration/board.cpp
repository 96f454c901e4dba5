#include "app/tools/calibration/board.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "catchlight/tag.hpp"
#include "catchlight/util/statistics.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/refinement/corner_refinement.hpp"

namespace catchlight::app {
namespace {

using tracking::Detection;

class Checkerboard : public CalibrationBoard {
 public:
  Checkerboard(const glm::ivec2& inner_corners, double square_m)
      : shape_(inner_corners.x, inner_corners.y), square_m_(square_m) {}

  std::optional<BoardView> find(const LumaView& luma, const CameraModel&) override {
    // OpenCV only reads the picture, but its type is not const-correct.
    const cv::Mat picture(luma.height_px, luma.width_px, CV_8UC1, const_cast<std::uint8_t*>(luma.data),
                          static_cast<std::size_t>(luma.stride));
    std::vector<cv::Point2f> corners;
    if (!cv::findChessboardCornersSB(picture, shape_, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY)) return {};
    refine(picture, corners);
    BoardView view;
    for (int i = 0; i < shape_.area(); ++i) {
      view.points_board_m.emplace_back(square_m_ * (i % shape_.width), square_m_ * (i / shape_.width));
      view.points_px.emplace_back(corners[i].x, corners[i].y);
    }
    constexpr double kRiseOfGaussian = 2.563;  // from 10 to 90 per cent, in standard deviations
    view.blur_px = cv::estimateChessboardSharpness(picture, shape_, corners)[0] / kRiseOfGaussian;
    return view;
  }

  /// It needs none: around a meeting of four squares blur, coding and distortion are symmetrical.
  bool needs_camera() const override { return false; }

 private:
  /// Moves corners by gradients (Foerstner & Guelch 1987) in windows that see one corner only: a third less error on real boards.
  void refine(const cv::Mat& picture, std::vector<cv::Point2f>& corners) const {
    double square_px = std::numeric_limits<double>::max();
    for (int i = 0; i < shape_.area(); ++i) {
      if (i % shape_.width > 0) square_px = std::min(square_px, cv::norm(corners[i] - corners[i - 1]));
      if (i >= shape_.width) square_px = std::min(square_px, cv::norm(corners[i] - corners[i - shape_.width]));
    }
    constexpr double kShareOfSquare = 0.4;
    const int reach_px = std::clamp(static_cast<int>(kShareOfSquare * square_px), 2, 11);
    const cv::TermCriteria until(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-4);
    cv::cornerSubPix(picture, corners, {reach_px, reach_px}, {-1, -1}, until);
  }

  cv::Size shape_;
  double square_m_;
};

/// A wrong id would stand in a wrong place: bits are not corrected.
tracking::TrackerOptions exact_bits() {
  tracking::TrackerOptions options;
  options.max_hamming = 0;
  return options;
}

class TagBoard : public CalibrationBoard {
 public:
  explicit TagBoard(const TagGrid& grid) : grid_(grid), detector_(grid.family, exact_bits()) {
    for (int i = 0; i < grid.count(); ++i) layouts_.push_back(tracking::tag_layout(grid.family, grid.first_id + i));
  }

  std::optional<BoardView> find(const LumaView& luma, const CameraModel& camera) override {
    BoardView view;
    std::vector<double> blurs_px;
    for (const auto& [index, detection] : tags_of_the_board(detector_.detect(luma)))
      add_tag(view, blurs_px, index, tracking::refine_corners(luma, camera, detection.corners_px, layouts_[index]));
    constexpr std::size_t kMinTags = 4;
    if (view.points_px.size() < 4 * kMinTags) return {};
    view.blur_px = median(std::move(blurs_px));
    return view;
  }

  /// Edges are straight only where distortion is taken out.
  bool needs_camera() const override { return true; }

 private:
  /// The detections by index; an id that is in view twice cannot be told apart and is left out.
  std::map<int, Detection> tags_of_the_board(const std::vector<Detection>& detections) const {
    std::map<int, Detection> tags;
    std::map<int, int> times;
    for (const Detection& detection : detections) {
      const int index = detection.id - grid_.first_id;
      if (index < 0 || index >= grid_.count()) continue;
      ++times[index];
      tags[index] = detection;
    }
    std::erase_if(tags, [&](const auto& tag) { return times[tag.first] > 1; });
    return tags;
  }

  /// Whole tags whose four edges could be placed; a corner left where the detector saw it is a third of a pixel off.
  void add_tag(BoardView& view, std::vector<double>& blurs_px, int index, const tracking::RefinedCorners& refined) const {
    const auto& placed = refined.edge_refined;
    if (!std::all_of(placed.begin(), placed.end(), [](bool edge) { return edge; })) return;
    const auto corners_m = tag_corners_m(grid_.size_m);
    for (int i = 0; i < 4; ++i) {
      view.points_board_m.emplace_back(grid_.center_m(index) + corners_m[i]);
      view.points_px.push_back(refined.corners_px[i]);
      blurs_px.push_back(refined.edge_blur_px[i]);
    }
  }

  TagGrid grid_;
  tracking::Detector detector_;
  std::vector<tracking::TagLayout> layouts_;
};

}  // namespace

std::unique_ptr<CalibrationBoard> make_checkerboard(const glm::ivec2& inner_corners, double square_m) {
  return std::make_unique<Checkerboard>(inner_corners, square_m);
}

std::unique_ptr<CalibrationBoard> make_tag_board(const TagGrid& grid) {
  return std::make_unique<TagBoard>(grid);
}

}  // namespace catchlight::app
