// A composite against the path-traced truth, region by region.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace catchlight::app {

/// Display-coded errors in units of 1/255, over one region of one frame.
struct PictureError {
  double mean = 0;     ///< mean of the largest channel difference, after a small box that takes noise out
  double p95 = 0;      ///< 95th percentile of the same
  double psnr_db = 0;  ///< PSNR of the raw difference, all channels
  double ssim = 0;     ///< mean of the structural similarity map (Wang 2004) over the region
  int pixels = 0;
};

struct TruthComparison {
  PictureError mask;                  ///< inside the object, less its rim
  PictureError shadow;                ///< outside it, where the object changes the real surface by more than 4 of 255
  PictureError glare;                 ///< outside it too, where its light brightens the picture by more than that
  PictureError elsewhere;             ///< the rest, where the composite must be the plate
  double shadow_untouched_mean = 0;   ///< what `shadow.mean` would be with nothing done
  double glare_untouched_mean = 0;    ///< and `glare.mean`
  double elsewhere_changed_mean = 0;  ///< mean difference from the plate elsewhere: 0 when untouched pixels are untouched
};

/// All 8-bit BGR of one size; `mask` is the object's coverage, one channel. `plate_clean` is the noiseless plate.
TruthComparison compare_with_truth(const cv::Mat& ours, const cv::Mat& truth, const cv::Mat& plate, const cv::Mat& plate_clean,
                                   const cv::Mat& mask);

/// Means over frames; regions that were empty in a frame do not count in it.
TruthComparison mean_of(const std::vector<TruthComparison>& frames);

}  // namespace catchlight::app
