#include "app/tools/calibration/collect.hpp"

#include <algorithm>
#include <array>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "app/support/progress.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/util/statistics.hpp"
#include "render/settings.hpp"
#include "tracking/camera/camera_file.hpp"

namespace catchlight::app {
namespace {

constexpr std::int64_t kMaxTries = 150;
constexpr std::int64_t kStretchOfUnknown = 5;  ///< frames; where the footage does not say how long it is
constexpr std::size_t kMaxViews = 40;
constexpr double kBlurRatio = 2;
constexpr double kGuessedFovDeg = 60;

/// Mean square of the Laplacian: falls quickly with blur, and is only compared between neighbouring frames.
double sharpness(const LumaView& luma) {
  const cv::Mat picture(luma.height_px, luma.width_px, CV_8UC1, const_cast<std::uint8_t*>(luma.data),
                        static_cast<std::size_t>(luma.stride));
  cv::Mat laplacian;
  cv::Laplacian(picture, laplacian, CV_16S);
  return cv::norm(laplacian, cv::NORM_L2SQR) / static_cast<double>(picture.total());
}

/// A view in numbers (where in the picture, how large, how tilted and how turned it is), so scaled that equal steps are worth the
/// same.
using Look = std::array<double, 7>;

Look look_of(const BoardView& view, int width_px, int height_px) {
  glm::dvec2 low = view.points_board_m.front(), high = low;
  for (const glm::dvec2& p : view.points_board_m) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  std::vector<cv::Point2d> board, seen;
  for (const glm::dvec2& p : view.points_board_m) {
    const glm::dvec2 centred = (p - low) / (high - low) - 0.5;
    board.emplace_back(centred.x, centred.y);
  }
  for (const glm::dvec2& p : view.points_px) seen.emplace_back(p.x / width_px, p.y / height_px);
  const cv::Mat h = cv::findHomography(board, seen);
  if (h.empty()) return {};
  const auto at = [&](int row, int column) { return h.at<double>(row, column); };
  const double angle = std::atan2(at(1, 0), at(0, 0));
  constexpr double kTiltWeight = 2, kTurnWeight = 0.3;
  const double size = std::sqrt(std::abs(at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0)));
  return {at(0, 2),
          at(1, 2),
          size,
          kTiltWeight * at(2, 0),
          kTiltWeight * at(2, 1),
          kTurnWeight * std::cos(angle),
          kTurnWeight * std::sin(angle)};
}

double distance(const Look& a, const Look& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// Never more than kMaxViews.
class ViewPool {
 public:
  void add(SeenBoard board) {
    looks_.push_back(look_of(board.view, board.frame.width_px(), board.frame.height_px()));
    boards_.push_back(std::move(board));
    if (boards_.size() <= kMaxViews) return;
    const auto dropped = static_cast<std::ptrdiff_t>(most_dispensable());
    boards_.erase(boards_.begin() + dropped);
    looks_.erase(looks_.begin() + dropped);
  }

  std::vector<SeenBoard> take() { return std::move(boards_); }

 private:
  std::size_t most_dispensable() const {
    std::size_t first = 0, second = 1;
    for (std::size_t i = 0; i < looks_.size(); ++i)
      for (std::size_t j = i + 1; j < looks_.size(); ++j)
        if (distance(looks_[i], looks_[j]) < distance(looks_[first], looks_[second])) {
          first = i;
          second = j;
        }
    return boards_[first].view.blur_px > boards_[second].view.blur_px ? first : second;
  }

  std::vector<SeenBoard> boards_;
  std::vector<Look> looks_;
};

/// Frames in order, the next of them within the range; at damage as at the end.
class RangeReader {
 public:
  RangeReader(MediaSource& source, const FrameRange& range) : source_(source), range_(range) {}

  std::optional<Frame> next() {
    try {
      while (auto frame = source_.read()) {
        if (frame->number() >= range_.end) return {};
        if (range_.contains(frame->number())) return frame;
      }
    } catch (const DamagedMedia& broken) {
      damage = broken.what();
    }
    return {};
  }

  std::optional<std::string> damage;

 private:
  MediaSource& source_;
  FrameRange range_;
};

/// How many of the footage's frames are in the range, where that can be known.
std::optional<std::int64_t> frames_in_range(const SourceInfo& info, const FrameRange& range) {
  const std::int64_t begin = std::max(range.begin, info.first_number);
  if (info.frame_count) return std::max<std::int64_t>(0, std::min(range.end, info.first_number + *info.frame_count) - begin);
  if (range.end != FrameRange{}.end) return range.end - begin;
  return {};
}

void leave_out_blurred(CollectedViews& views) {
  if (views.boards.empty()) return;
  std::vector<double> blurs_px;
  for (const SeenBoard& board : views.boards) blurs_px.push_back(board.view.blur_px);
  const double limit_px = kBlurRatio * median(std::move(blurs_px));
  std::erase_if(views.boards, [&](const SeenBoard& board) {
    const bool is_blurred = board.view.blur_px > limit_px;
    if (is_blurred) views.blurred.push_back(board.view.frame);
    return is_blurred;
  });
}

/// Looks for the board in the sharpest frame of each stretch.
class BoardSearch {
 public:
  BoardSearch(CalibrationBoard& board, const CameraModel& camera, std::int64_t stretch, CollectedViews& views)
      : board_(board), camera_(camera), stretch_(stretch), views_(views) {}

  void offer(Frame frame) {
    const double sharp = stretch_ > 1 ? sharpness(frame.luma()) : 0;
    if (!sharpest_ || sharp > best_) {
      best_ = sharp;
      sharpest_ = std::move(frame);
    }
    if (++views_.frames_read % stretch_ == 0) try_sharpest();
  }

  void finish() {
    if (sharpest_) try_sharpest();
    views_.boards = pool_.take();
  }

 private:
  void try_sharpest() {
    ++views_.frames_tried;
    const Frame frame = *std::exchange(sharpest_, std::nullopt);
    auto view = board_.find(frame.luma(), camera_);
    if (!view) return;
    ++views_.frames_with_board;
    view->frame = frame.number();
    pool_.add({std::move(*view), frame});
  }

  CalibrationBoard& board_;
  CameraModel camera_;
  std::int64_t stretch_;
  CollectedViews& views_;
  ViewPool pool_;
  std::optional<Frame> sharpest_;
  double best_ = 0;
};

}  // namespace

CollectedViews collect_views(MediaSource& source, CalibrationBoard& board, const FrameRange& range, Log& log) {
  const SourceInfo& info = source.info();
  const auto total = frames_in_range(info, range);
  const std::int64_t stretch = total ? std::max<std::int64_t>(1, (*total + kMaxTries - 1) / kMaxTries) : kStretchOfUnknown;
  CollectedViews views;
  views.width_px = info.width_px;
  views.height_px = info.height_px;
  RangeReader reader(source, range);
  BoardSearch search(board, tracking::camera_from_field_of_view(info.width_px, info.height_px, kGuessedFovDeg), stretch, views);
  Progress progress(log, "boards", total);
  while (auto frame = reader.next()) {
    search.offer(std::move(*frame));
    progress.update(views.frames_read);
  }
  search.finish();
  views.damage = reader.damage;
  leave_out_blurred(views);
  return views;
}

}  // namespace catchlight::app
