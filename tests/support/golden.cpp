#include "tests/support/golden.hpp"

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "render/gl/gl_context.hpp"

namespace catchlight::render::test {
namespace {

std::string figures(const ImageDifference& difference, const GoldenTolerance& tolerance) {
  const auto line = [](const char* what, double value, double allowed) {
    return std::string("  ") + what + " " + std::to_string(value) + " (allowed " + std::to_string(allowed) + ")\n";
  };
  return line("max  of 255:", 255 * difference.max_abs, 255 * tolerance.max_abs) +
         line("mean of 255:", 255 * difference.mean_abs, 255 * tolerance.mean_abs) +
         line("SSIM:       ", difference.ssim, tolerance.min_ssim);
}

}  // namespace

GoldenTolerance golden_tolerance() {
  return gl_info().renderer.starts_with("llvmpipe") ? kSoftwareTolerance : kHardwareTolerance;
}

bool within(const ImageDifference& difference, const GoldenTolerance& tolerance) {
  return difference.max_abs <= tolerance.max_abs && difference.mean_abs <= tolerance.mean_abs &&
         difference.ssim >= tolerance.min_ssim;
}

::testing::AssertionResult matches_golden(const cv::Mat& picture, const std::string& name, const GoldenTolerance& tolerance) {
  const std::string golden_path = std::string(CATCHLIGHT_SOURCE_DIR) + "/tests/golden/" + name + ".png";
  if (std::getenv("CATCHLIGHT_BLESS") != nullptr) {
    cv::imwrite(golden_path, picture);
    return ::testing::AssertionSuccess() << "blessed " << golden_path;
  }
  const std::string folder = std::string(CATCHLIGHT_BINARY_DIR) + "/golden";
  std::filesystem::create_directories(folder);
  const std::string actual_path = folder + "/" + name + ".actual.png", difference_path = folder + "/" + name + ".difference.png";
  const std::string bless =
      "\nlook at them, and if the new picture is right: CATCHLIGHT_BLESS=1 build/release/tests/render/tests_render_gl "
      "--gtest_filter=GoldenGl.*";

  const cv::Mat golden = cv::imread(golden_path);
  if (golden.empty() || golden.size() != picture.size()) {
    cv::imwrite(actual_path, picture);
    return ::testing::AssertionFailure() << "no golden picture of this size\n  golden: " << golden_path
                                         << "\n  actual: " << actual_path << bless;
  }
  const ImageDifference difference = image_difference(picture, golden);
  if (within(difference, tolerance)) return ::testing::AssertionSuccess();
  cv::Mat enlarged;
  cv::absdiff(picture, golden, enlarged);
  cv::imwrite(actual_path, picture);
  cv::imwrite(difference_path, enlarged * 8);
  return ::testing::AssertionFailure() << name << " differs\n"
                                       << figures(difference, tolerance) << "  golden:         " << golden_path
                                       << "\n  actual:         " << actual_path << "\n  difference x 8: " << difference_path
                                       << bless;
}

}  // namespace catchlight::render::test
