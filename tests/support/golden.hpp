// Pictures that must stay as they were looked at and found right.
#pragma once

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>

#include "render/image/image_difference.hpp"

namespace catchlight::render::test {

/// What two pictures may differ by, in display codes of full scale 1.
struct GoldenTolerance {
  double max_abs, mean_abs, min_ssim;
};

/// llvmpipe gives the same bytes on every processor tried; other versions of it may round a code differently here and there.
inline constexpr GoldenTolerance kSoftwareTolerance{2.0 / 255, 0.05 / 255, 0.9995};
/// Other drivers place samples, filter and raise to powers in their own way.
inline constexpr GoldenTolerance kHardwareTolerance{12.0 / 255, 0.6 / 255, 0.995};

/// The tolerance for the current context.
GoldenTolerance golden_tolerance();

bool within(const ImageDifference& difference, const GoldenTolerance& tolerance);

/// Compares 8-bit BGR `picture` with tests/golden/NAME.png. Where they differ, or there is none, fails with the figures, and
/// leaves the picture and the difference (8 times enlarged) under the build folder. CATCHLIGHT_BLESS=1 in the environment makes
/// the picture the golden one.
::testing::AssertionResult matches_golden(const cv::Mat& picture, const std::string& name, const GoldenTolerance& tolerance);

}  // namespace catchlight::render::test
