// How far two pictures are apart, in display codes. Max, mean and structure together: each alone can be fooled.
#pragma once

#include <opencv2/core.hpp>

namespace catchlight::render {

/// Differences in units of full scale (code 1, or 255 of 8 bits), over all pixels and channels.
struct ImageDifference {
  double max_abs = 0;
  double mean_abs = 0;
  double p99 = 0;      ///< 99th percentile of the absolute differences
  double psnr_db = 0;  ///< infinite for equal pictures
  double ssim = 1;     ///< mean of structural_similarity_map()
};

/// Compares pictures, both 8-bit or 32-bit float (0..1), of the same size and channels; throws Error otherwise. NaN equals NaN
/// and an infinity itself; any other pair with one of them is infinitely far apart.
ImageDifference image_difference(const cv::Mat& a, const cv::Mat& b);

/// Structural similarity per pixel, mean over the channels, 32-bit float: Wang, Bovik, Sheikh & Simoncelli 2004 with their 11 x
/// 11 Gaussian of sigma 1.5, K1 = 0.01, K2 = 0.03. Same requirements as image_difference().
cv::Mat structural_similarity_map(const cv::Mat& a, const cv::Mat& b);

}  // namespace catchlight::render
