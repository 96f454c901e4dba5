#include "app/tools/replay/truth_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "catchlight/util/statistics.hpp"
#include "render/image/image_difference.hpp"

namespace catchlight::app {

namespace {

constexpr double kObjectChanges = 4.0;  // 8-bit codes, after a 9 x 9 box
constexpr int kMinPixels = 20;

cv::Mat boxed(const cv::Mat& image, int size) {
  cv::Mat wide, smooth;
  image.convertTo(wide, CV_32F);
  cv::blur(wide, smooth, {size, size});
  return smooth;
}

cv::Mat largest_channel(const cv::Mat& image) {
  cv::Mat channels[3];
  cv::split(image, channels);
  return cv::max(cv::max(channels[0], channels[1]), channels[2]);
}

/// The largest difference over the channels, pixel by pixel. 32-bit float.
cv::Mat largest_difference(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference;
  cv::absdiff(a, b, difference);
  return largest_channel(difference);
}

double masked_mean(const cv::Mat& values, const cv::Mat& region) {
  return cv::mean(values, region)[0];
}

double masked_percentile(const cv::Mat& values, const cv::Mat& region, double share) {
  std::vector<float> chosen;
  for (int y = 0; y < values.rows; ++y)
    for (int x = 0; x < values.cols; ++x)
      if (region.at<std::uint8_t>(y, x)) chosen.push_back(values.at<float>(y, x));
  return quantile(std::move(chosen), share);
}

PictureError picture_error(const cv::Mat& ours, const cv::Mat& truth, int box, const cv::Mat& ssim_map, const cv::Mat& region) {
  PictureError error;
  error.pixels = cv::countNonZero(region);
  if (error.pixels < kMinPixels) return {};
  const cv::Mat smooth = largest_difference(boxed(ours, box), boxed(truth, box));
  error.mean = masked_mean(smooth, region);
  error.p95 = masked_percentile(smooth, region, 0.95);
  cv::Mat difference;
  cv::absdiff(ours, truth, difference);
  difference.convertTo(difference, CV_32F);
  const cv::Scalar squares = cv::mean(difference.mul(difference), region);
  error.psnr_db = 10 * std::log10(255.0 * 255.0 / std::max((squares[0] + squares[1] + squares[2]) / 3, 1e-10));
  error.ssim = masked_mean(ssim_map, region);
  return error;
}

void add(PictureError& sum, const PictureError& error, int& frames) {
  if (error.pixels == 0) return;
  sum.mean += error.mean;
  sum.p95 += error.p95;
  sum.psnr_db += error.psnr_db;
  sum.ssim += error.ssim;
  sum.pixels += error.pixels;
  ++frames;
}

void divide(PictureError& sum, int frames) {
  if (frames == 0) return;
  sum.mean /= frames;
  sum.p95 /= frames;
  sum.psnr_db /= frames;
  sum.ssim /= frames;
  sum.pixels /= frames;
}

}  // namespace

TruthComparison compare_with_truth(const cv::Mat& ours, const cv::Mat& truth, const cv::Mat& plate, const cv::Mat& plate_clean,
                                   const cv::Mat& mask) {
  cv::Mat eroded, dilated;
  cv::erode(mask, eroded, cv::Mat::ones(3, 3, CV_8U));
  cv::dilate(mask, dilated, cv::Mat::ones(5, 5, CV_8U));
  const cv::Mat inner = eroded > 252, outer = dilated < 3;
  cv::Mat change;
  cv::blur(largest_difference(boxed(truth, 1), boxed(plate_clean, 1)), change, {9, 9});
  const cv::Mat shadow = outer & (change > kObjectChanges), elsewhere = outer & ~shadow;
  cv::Mat brighter;
  cv::subtract(boxed(truth, 9), boxed(plate_clean, 9), brighter);
  cv::Mat boxes_reach;  // the object's own light within a box's reach is no glare
  cv::dilate(mask, boxes_reach, cv::Mat::ones(13, 13, CV_8U));
  const cv::Mat glare = (boxes_reach < 3) & (largest_channel(brighter) > kObjectChanges);
  const cv::Mat ssim_map = render::structural_similarity_map(ours, truth);

  TruthComparison result;
  result.mask = picture_error(ours, truth, 3, ssim_map, inner);
  result.shadow = picture_error(ours, truth, 5, ssim_map, shadow);
  result.elsewhere = picture_error(ours, truth, 5, ssim_map, elsewhere);
  result.shadow_untouched_mean = picture_error(plate, truth, 5, ssim_map, shadow).mean;
  result.glare = picture_error(ours, truth, 5, ssim_map, glare);
  result.glare_untouched_mean = picture_error(plate, truth, 5, ssim_map, glare).mean;
  result.elsewhere_changed_mean = masked_mean(largest_difference(boxed(ours, 1), boxed(plate, 1)), elsewhere);
  return result;
}

TruthComparison mean_of(const std::vector<TruthComparison>& frames) {
  TruthComparison sum;
  int mask_frames = 0, shadow_frames = 0, glare_frames = 0, elsewhere_frames = 0;
  for (const TruthComparison& frame : frames) {
    add(sum.mask, frame.mask, mask_frames);
    add(sum.shadow, frame.shadow, shadow_frames);
    add(sum.glare, frame.glare, glare_frames);
    add(sum.elsewhere, frame.elsewhere, elsewhere_frames);
    sum.shadow_untouched_mean += frame.shadow_untouched_mean;
    sum.glare_untouched_mean += frame.glare_untouched_mean;
    sum.elsewhere_changed_mean += frame.elsewhere_changed_mean;
  }
  divide(sum.mask, mask_frames);
  divide(sum.shadow, shadow_frames);
  divide(sum.glare, glare_frames);
  divide(sum.elsewhere, elsewhere_frames);
  if (shadow_frames > 0) sum.shadow_untouched_mean /= shadow_frames;
  if (glare_frames > 0) sum.glare_untouched_mean /= glare_frames;
  if (!frames.empty()) sum.elsewhere_changed_mean /= static_cast<double>(frames.size());
  return sum;
}

}  // namespace catchlight::app
