#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "app/support/lettering.hpp"
#include "app/tools/calibration/report.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr int kWidthPx = 1280, kBarsPx = 200, kMarginPx = 40;
constexpr double kTypicalArrowPx = 14;  ///< length of a residual as large as the RMS
const cv::Scalar kPaper(255, 255, 255), kGrid(225, 225, 225), kInk(60, 60, 60), kPoint(190, 150, 90), kResidual(30, 30, 220),
    kBar(190, 150, 90), kRejected(60, 60, 220);

void write(cv::Mat& picture, const std::string& text, const glm::dvec2& baseline_px, double capital_px = 10) {
  write_text(picture, text, baseline_px, capital_px, kInk);
}

/// One, two or five times a power of ten.
double round_down(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  const double rest = value / power;
  return power * (rest >= 5 ? 5 : rest >= 2 ? 2 : 1);
}

void draw_line(cv::Mat& picture, const glm::dvec2& a, const glm::dvec2& b, const cv::Scalar& color) {
  constexpr int kShift = 4;  // sixteenths of a pixel
  const auto fine = [](const glm::dvec2& p) { return cv::Point(cvRound(16 * p.x), cvRound(16 * p.y)); };
  cv::line(picture, fine(a), fine(b), color, 1, cv::LINE_AA, kShift);
}

cv::Mat residual_map(const Calibration& calibration) {
  const CameraModel& camera = calibration.camera;
  const double scale = static_cast<double>(kWidthPx) / camera.width_px;
  cv::Mat picture(cvRound(camera.height_px * scale), kWidthPx, CV_8UC3, kPaper);
  for (int i = 1; i < 3; ++i) {
    cv::line(picture, {picture.cols * i / 3, 0}, {picture.cols * i / 3, picture.rows}, kGrid);
    cv::line(picture, {0, picture.rows * i / 3}, {picture.cols, picture.rows * i / 3}, kGrid);
  }
  const double magnified = round_down(kTypicalArrowPx / std::max(calibration.rms_px, 1e-6));
  for (const ViewFit& fit : calibration.views)
    for (std::size_t i = 0; i < fit.view.points_px.size(); ++i) {
      const glm::dvec2 at = (fit.view.points_px[i] + 0.5) * scale;
      cv::circle(picture, cv::Point(cvRound(at.x), cvRound(at.y)), 2, kPoint, cv::FILLED, cv::LINE_AA);
      draw_line(picture, at, at + magnified * fit.residuals_px[i], kResidual);
    }
  write(picture, "used corners of " + counted(calibration.views.size(), "frame") + "; residuals x " + plain_text(magnified),
        {8, 18});
  return picture;
}

struct Bar {
  std::int64_t frame;
  double rms_px;
  bool is_rejected;
};

cv::Mat error_bars(const Calibration& calibration) {
  std::vector<Bar> bars;
  for (const ViewFit& fit : calibration.views) bars.push_back({fit.view.frame, fit.rms_px, false});
  for (const RejectedView& view : calibration.rejected) bars.push_back({view.frame, view.rms_px, true});
  std::sort(bars.begin(), bars.end(), [](const Bar& a, const Bar& b) { return a.frame < b.frame; });
  cv::Mat picture(kBarsPx, kWidthPx, CV_8UC3, kPaper);
  // Rejected frames may be far off: they are cut at twice the largest error of the others.
  double largest_px = 1e-6;
  for (const ViewFit& fit : calibration.views) largest_px = std::max(largest_px, fit.rms_px);
  if (!calibration.rejected.empty()) largest_px *= 2;
  const int bottom = kBarsPx - kMarginPx, height = kBarsPx - 2 * kMarginPx;
  const double pitch = static_cast<double>(kWidthPx - 2 * kMarginPx) / static_cast<double>(bars.size());
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const int left = kMarginPx + static_cast<int>(pitch * static_cast<double>(i)),
              width = std::max(1, static_cast<int>(pitch * 0.7));
    const int top = bottom - static_cast<int>(height * std::min(1.0, bars[i].rms_px / largest_px));
    cv::rectangle(picture, {left, top}, {left + width, bottom}, bars[i].is_rejected ? kRejected : kBar, cv::FILLED);
    write(picture, std::to_string(bars[i].frame), {left, bottom + 14}, 7);
  }
  const int mean_y = bottom - static_cast<int>(height * std::min(1.0, calibration.rms_px / largest_px));
  cv::line(picture, {kMarginPx, mean_y}, {kWidthPx - kMarginPx, mean_y}, kInk);
  write(picture,
        "error per frame; line: " + fixed_text(calibration.rms_px, 3) + " px RMS over all" +
            (calibration.rejected.empty() ? "" : "; red: rejected"),
        {kMarginPx, 24});
  return picture;
}

}  // namespace

cv::Mat calibration_picture(const Calibration& calibration) {
  cv::Mat picture;
  const cv::Mat line(2, kWidthPx, CV_8UC3, kInk);
  cv::vconcat(std::vector<cv::Mat>{residual_map(calibration), line, error_bars(calibration)}, picture);
  return picture;
}

}  // namespace catchlight::app
