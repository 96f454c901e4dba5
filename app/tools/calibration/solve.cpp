#include "app/tools/calibration/solve.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <optional>

#include "app/tools/calibration/uncertainty.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/statistics.hpp"

namespace catchlight::app {
namespace {

constexpr std::size_t kMinViews = 4;
constexpr double kOutlierRatio = 3;
constexpr double kNegligiblePx = 0.05;    ///< views this good are no outliers, however good the others are
constexpr double kMinPerspective = 0.02;  ///< nearest point over farthest, less 1, of the most tilted view
constexpr double kWorstFocal = 0.05;      ///< standard deviation over the focal length
constexpr double kRadToDeg = 180 / std::numbers::pi;

struct Fit {
  LensModel model = LensModel::plain;
  cv::Mat matrix, coefficients, errors_px;
  std::vector<cv::Mat> rotations, translations;
  double criterion = 0;
};

/// What OpenCV wants: one list of points for each view.
struct Points {
  std::vector<std::vector<cv::Point3f>> board_m;
  std::vector<std::vector<cv::Point2f>> seen_px;

  explicit Points(const std::vector<BoardView>& views) {
    for (const BoardView& view : views) {
      board_m.emplace_back();
      seen_px.emplace_back();
      for (const glm::dvec2& p : view.points_board_m) board_m.back().emplace_back(cv::Point3d(p.x, p.y, 0));
      for (const glm::dvec2& p : view.points_px) seen_px.back().emplace_back(cv::Point2d(p.x, p.y));
    }
  }

  double count() const {
    std::size_t count = 0;
    for (const auto& view : seen_px) count += view.size();
    return static_cast<double>(count);
  }
};

int flags_of(LensModel model) {
  int flags = cv::CALIB_USE_QR;  // several times as fast as the default, singular values
  if (model == LensModel::rational) flags |= cv::CALIB_RATIONAL_MODEL;
  if (model < LensModel::standard) flags |= cv::CALIB_FIX_K3;
  if (model < LensModel::four) flags |= cv::CALIB_FIX_K2 | cv::CALIB_ZERO_TANGENT_DIST;
  if (model < LensModel::radial) flags |= cv::CALIB_FIX_K1;
  return flags;
}

/// The solution that starts from that of a smaller model, where there is one. Empty where OpenCV finds none.
std::optional<Fit> fit(const Points& points, const cv::Size& size, LensModel model, const Fit* start) {
  Fit result;
  result.model = model;
  int flags = flags_of(model);
  if (start) {
    flags |= cv::CALIB_USE_INTRINSIC_GUESS;
    result.matrix = start->matrix.clone();
    result.coefficients = cv::Mat::zeros(1, model == LensModel::rational ? 8 : 5, CV_64F);
    start->coefficients.reshape(1, 1).copyTo(result.coefficients.colRange(0, static_cast<int>(start->coefficients.total())));
  }
  const cv::TermCriteria until(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 100, 1e-9);
  cv::Mat ignored;
  double rms_px = 0;
  try {
    rms_px = cv::calibrateCamera(points.board_m, points.seen_px, size, result.matrix, result.coefficients, result.rotations,
                                 result.translations, ignored, ignored, result.errors_px, flags, until);
  } catch (const cv::Exception&) {
    return {};
  }
  const bool is_camera = result.matrix.at<double>(0, 0) > 0 && result.matrix.at<double>(1, 1) > 0;
  if (!std::isfinite(rms_px) || !is_camera) return {};  // the mirror image behind the camera projects alike
  // Per coordinate, and never less than a thousandth of a pixel: that much is no evidence.
  const double variance_px2 = rms_px * rms_px / 2 + 1e-6, observations = 2 * points.count();
  const double parameters = 4 + coefficient_count(model) + 6.0 * static_cast<double>(points.seen_px.size());
  result.criterion = observations * std::log(variance_px2) + parameters * std::log(observations);
  return result;
}

/// The depth of the farthest point over that of the nearest, less 1, as the view's homography says.
double perspective(const BoardView& view) {
  std::vector<cv::Point2d> board, seen;
  for (const glm::dvec2& p : view.points_board_m) board.emplace_back(p.x, p.y);
  for (const glm::dvec2& p : view.points_px) seen.emplace_back(p.x, p.y);
  const cv::Mat h = cv::findHomography(board, seen);
  if (h.empty()) return 0;
  double nearest = std::numeric_limits<double>::max(), farthest = 0;
  for (const cv::Point2d& p : board) {
    const double depth = std::abs(h.at<double>(2, 0) * p.x + h.at<double>(2, 1) * p.y + h.at<double>(2, 2));
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  return nearest > 0 ? farthest / nearest - 1 : 0;
}

[[noreturn]] void refuse_frontal() {
  throw Error(
      "these views do not determine the focal length: the board is nearly frontal in all of them, or always seen from the same "
      "side; film it tilted by 30 degrees and more, to several sides");
}

void check_views(const std::vector<BoardView>& views, const std::string& why) {
  if (views.size() < kMinViews)
    throw Error("only " + std::to_string(views.size()) + " usable views of the board" + why + "; at least " +
                std::to_string(kMinViews) + " are needed, and 10 to 40 are good: film it from more sides");
  double most = 0;
  for (const BoardView& view : views) most = std::max(most, perspective(view));
  if (most < kMinPerspective) refuse_frontal();
}

/// The best model for these views.
Fit best_fit(const std::vector<BoardView>& views, const cv::Size& size, LensModel most) {
  const Points points(views);
  std::optional<Fit> best, last;
  for (int model = 0; model <= static_cast<int>(most); ++model) {
    auto next = fit(points, size, static_cast<LensModel>(model), last ? &*last : nullptr);
    if (!next) continue;
    last = next;
    if (!best || next->criterion < best->criterion) best = std::move(next);
  }
  if (!best) refuse_frontal();
  return *best;
}

CameraModel camera_model(const Fit& fit, const cv::Size& size) {
  CameraModel camera;
  camera.width_px = size.width;
  camera.height_px = size.height;
  camera.fx_px = fit.matrix.at<double>(0, 0);
  camera.fy_px = fit.matrix.at<double>(1, 1);
  camera.cx_px = fit.matrix.at<double>(0, 2);
  camera.cy_px = fit.matrix.at<double>(1, 2);
  const cv::Mat coefficients = fit.coefficients.reshape(1, 1);
  for (int i = 0; i < coefficient_count(fit.model); ++i) camera.distortion[i] = coefficients.at<double>(i);
  return camera;
}

std::vector<cv::Point3d> board_points(const BoardView& view) {
  std::vector<cv::Point3d> points;
  for (const glm::dvec2& p : view.points_board_m) points.emplace_back(p.x, p.y, 0);
  return points;
}

/// `rms_px` of the residuals' lengths over all `points`.
CameraModel deviations_of(const std::vector<BoardView>& views, const Fit& fit, const cv::Size& size, double rms_px,
                          double points) {
  std::vector<SolvedView> solved;
  for (std::size_t i = 0; i < views.size(); ++i)
    solved.push_back({board_points(views[i]), fit.rotations[i], fit.translations[i]});
  const int coefficients = coefficient_count(fit.model);
  const double freedom = 2 * points - 4 - coefficients - 6.0 * static_cast<double>(views.size());
  const double variance_px2 = rms_px * rms_px * points / std::max(1.0, freedom);
  const std::vector<double> all = standard_deviations(solved, fit.matrix, fit.coefficients, coefficients, variance_px2);
  CameraModel deviation{size.width, size.height, all[0], all[1], all[2], all[3], {}};
  std::copy(all.begin() + 4, all.end(), deviation.distortion.begin());
  return deviation;
}

ViewFit view_fit(const BoardView& view, const Fit& fit, std::size_t index) {
  std::vector<cv::Point2d> projected;
  cv::projectPoints(board_points(view), fit.rotations[index], fit.translations[index], fit.matrix, fit.coefficients, projected);
  ViewFit result{view, {}, 0, 0};
  for (std::size_t i = 0; i < projected.size(); ++i) {
    result.residuals_px.push_back(view.points_px[i] - glm::dvec2(projected[i].x, projected[i].y));
    result.rms_px += glm::dot(result.residuals_px.back(), result.residuals_px.back());
  }
  result.rms_px = std::sqrt(result.rms_px / static_cast<double>(projected.size()));
  cv::Mat rotation;
  cv::Rodrigues(fit.rotations[index], rotation);
  result.tilt_deg = std::acos(std::min(1.0, std::abs(rotation.at<double>(2, 2)))) * kRadToDeg;
  return result;
}

/// Moves outliers from `views` to `rejected`; whether there were any.
bool reject_outliers(std::vector<BoardView>& views, const Fit& fit, std::vector<RejectedView>& rejected) {
  std::vector<double> errors_px(fit.errors_px.begin<double>(), fit.errors_px.end<double>());
  const double limit_px = std::max(kNegligiblePx, kOutlierRatio * median(errors_px));
  std::vector<BoardView> kept;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (errors_px[i] > limit_px)
      rejected.push_back({views[i].frame, errors_px[i]});
    else
      kept.push_back(std::move(views[i]));
  }
  const bool any = kept.size() < views.size();
  views = std::move(kept);
  return any;
}

}  // namespace

int coefficient_count(LensModel model) {
  constexpr std::array kCounts{0, 1, 4, 5, 8};
  return kCounts[static_cast<std::size_t>(model)];
}

Calibration solve_camera(std::vector<BoardView> views, int width_px, int height_px, LensModel most) {
  const cv::Size size(width_px, height_px);
  Calibration result;
  check_views(views, "");
  Fit fit = best_fit(views, size, most);
  while (reject_outliers(views, fit, result.rejected)) {
    check_views(views, " are left, " + std::to_string(result.rejected.size()) + " having been rejected as outliers");
    fit = best_fit(views, size, most);
  }
  result.camera = camera_model(fit, size);
  result.lens = fit.model;
  double sum_px2 = 0, count = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    result.views.push_back(view_fit(views[i], fit, i));
    const auto points = static_cast<double>(views[i].points_px.size());
    sum_px2 += result.views.back().rms_px * result.views.back().rms_px * points;
    count += points;
  }
  result.rms_px = std::sqrt(sum_px2 / count);
  result.deviation = deviations_of(views, fit, size, result.rms_px, count);
  const double focal = std::max(result.deviation.fx_px / result.camera.fx_px, result.deviation.fy_px / result.camera.fy_px);
  if (!(focal <= kWorstFocal)) refuse_frontal();
  return result;
}

}  // namespace catchlight::app
