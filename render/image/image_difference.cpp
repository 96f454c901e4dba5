#include "render/image/image_difference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "catchlight/error.hpp"

namespace catchlight::render {
namespace {

std::string shape_of(const cv::Mat& m) {
  return std::to_string(m.cols) + " x " + std::to_string(m.rows) + " " + cv::typeToString(m.type());
}

/// Codes 0..1 of a picture pair.
cv::Mat codes(const cv::Mat& picture) {
  cv::Mat result;
  picture.convertTo(result, CV_32F, picture.depth() == CV_8U ? 1.0 / 255 : 1.0);
  return result;
}

void check_comparable(const cv::Mat& a, const cv::Mat& b) {
  const bool known = a.depth() == CV_8U || a.depth() == CV_32F;
  if (known && !a.empty() && a.size() == b.size() && a.type() == b.type()) return;
  throw Error("pictures cannot be compared: " + shape_of(a) + " with " + shape_of(b) +
              "; needed: the same size and type, 8-bit or float");
}

double distance(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  return std::isfinite(a) && std::isfinite(b) ? std::abs(double{a} - double{b}) : std::numeric_limits<double>::infinity();
}

/// Non-finite values would spread over the whole window: equal ones become 0 in both, others 0 and 1.
void make_finite(cv::Mat& a, cv::Mat& b) {
  float* pa = a.ptr<float>();
  float* pb = b.ptr<float>();
  for (std::size_t i = 0; i < a.total() * static_cast<std::size_t>(a.channels()); ++i) {
    if (std::isfinite(pa[i]) && std::isfinite(pb[i])) continue;
    pb[i] = distance(pa[i], pb[i]) == 0 ? 0.0f : 1.0f;
    pa[i] = 0.0f;
  }
}

cv::Mat window_mean(const cv::Mat& image) {
  cv::Mat result;
  cv::GaussianBlur(image, result, {11, 11}, 1.5, 1.5, cv::BORDER_REFLECT);
  return result;
}

}  // namespace

ImageDifference image_difference(const cv::Mat& a, const cv::Mat& b) {
  check_comparable(a, b);
  const cv::Mat codes_a = codes(a), codes_b = codes(b);
  std::vector<double> distances(codes_a.total() * static_cast<std::size_t>(codes_a.channels()));
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double d = distances[i] = distance(codes_a.ptr<float>()[i], codes_b.ptr<float>()[i]);
    sum += d;
    squares += d * d;
  }
  const auto count = static_cast<double>(distances.size());
  ImageDifference result;
  result.max_abs = *std::ranges::max_element(distances);
  result.mean_abs = sum / count;
  result.psnr_db = squares > 0 ? -10 * std::log10(squares / count) : std::numeric_limits<double>::infinity();
  const auto at = distances.begin() + static_cast<std::ptrdiff_t>(0.99 * (count - 1));
  std::ranges::nth_element(distances, at);
  result.p99 = *at;
  result.ssim = cv::mean(structural_similarity_map(a, b))[0];
  return result;
}

cv::Mat structural_similarity_map(const cv::Mat& a, const cv::Mat& b) {
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  check_comparable(a, b);
  cv::Mat x = codes(a), y = codes(b);
  make_finite(x, y);
  // Doubles: a variance is the small difference of large means.
  x.convertTo(x, CV_64F);
  y.convertTo(y, CV_64F);
  const cv::Mat mean_x = window_mean(x), mean_y = window_mean(y);
  const cv::Mat mean_xx = mean_x.mul(mean_x), mean_yy = mean_y.mul(mean_y), mean_xy = mean_x.mul(mean_y);
  const cv::Mat variance_x = window_mean(x.mul(x)) - mean_xx, variance_y = window_mean(y.mul(y)) - mean_yy;
  const cv::Mat covariance = window_mean(x.mul(y)) - mean_xy;
  const cv::Scalar c1 = cv::Scalar::all(kC1), c2 = cv::Scalar::all(kC2);
  const cv::Mat numerator = cv::Mat(2 * mean_xy + c1).mul(cv::Mat(2 * covariance + c2));
  const cv::Mat denominator = cv::Mat(mean_xx + mean_yy + c1).mul(cv::Mat(variance_x + variance_y + c2));
  cv::Mat per_channel = numerator / denominator, map;
  cv::transform(per_channel, map, cv::Mat(1, x.channels(), CV_64F, cv::Scalar(1.0 / x.channels())));
  map.convertTo(map, CV_32F);
  return map;
}

}  // namespace catchlight::render
