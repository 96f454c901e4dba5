#include "app/tools/calibration/report.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr std::array kCoefficients{"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
constexpr double kGoodTiltDeg = 30;
constexpr std::size_t kGoodViews = 10;
constexpr double kGoodFocal = 0.01, kGoodCenter = 0.01;  ///< standard deviation over focal length and picture width
constexpr double kLargeRmsPx = 1;
constexpr double kUnusualAspect = 0.02;
constexpr double kHardlyAny = 0.01;  ///< share of all corners

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string with_deviation(const char* name, double value, double deviation, int digits) {
  return std::string(name) + ' ' + fixed_text(value, digits) + " +- " + fixed_text(deviation, digits);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

/// Those of nine parts of the picture where hardly any used corner lies.
std::vector<std::string> empty_parts(const Calibration& calibration) {
  constexpr std::array kParts{"upper left", "top",        "upper right", "left",       "middle",
                              "right",      "lower left", "bottom",      "lower right"};
  std::array<double, 9> seen{};
  double all = 0;
  for (const ViewFit& fit : calibration.views)
    for (const glm::dvec2& p : fit.view.points_px) {
      const int column = std::clamp(static_cast<int>(3 * p.x / calibration.camera.width_px), 0, 2);
      const int row = std::clamp(static_cast<int>(3 * p.y / calibration.camera.height_px), 0, 2);
      ++seen[static_cast<std::size_t>(3 * row + column)];
      ++all;
    }
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] < kHardlyAny * all) parts.push_back(kParts[i]);
  return parts;
}

/// Coefficients that stand at less than two standard deviations from 0, or were left at 0.
std::vector<std::string> undetermined_coefficients(const Calibration& calibration, LensModel most) {
  std::vector<std::string> names;
  const int used = coefficient_count(calibration.lens);
  for (int i = 0; i < coefficient_count(most); ++i) {
    const double value = calibration.camera.distortion[i], deviation = calibration.deviation.distortion[i];
    if (i >= used || !(std::abs(value) > 2 * deviation)) names.push_back(kCoefficients[i]);
  }
  return names;
}

int file_storage_format(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".yaml" || extension == ".yml") return cv::FileStorage::FORMAT_YAML;
  if (extension == ".json") return cv::FileStorage::FORMAT_JSON;
  if (extension == ".xml") return cv::FileStorage::FORMAT_XML;
  throw UsageError(path + ": expected a name that ends in .yaml, .yml, .json or .xml");
}

cv::FileStorage memory_file(const std::string& path) {
  return {"", cv::FileStorage::WRITE | cv::FileStorage::MEMORY | file_storage_format(path)};
}

/// Five coefficients, or eight where the last three are used.
void write_camera(cv::FileStorage& file, const CameraModel& camera) {
  const bool is_rational = std::any_of(camera.distortion.begin() + 5, camera.distortion.end(), [](double k) { return k != 0; });
  file << "image_width" << camera.width_px << "image_height" << camera.height_px;
  file << "camera_matrix" << cv::Mat(cv::Matx33d{camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1});
  file << "distortion_coefficients"
       << cv::Mat(1, is_rational ? 8 : 5, CV_64F, const_cast<double*>(camera.distortion.data())).clone();
}

}  // namespace

void check_camera_format(const std::string& path) {
  file_storage_format(path);
}

std::string camera_text(const Calibration& calibration, const std::string& path) {
  cv::FileStorage file = memory_file(path);
  write_camera(file, calibration.camera);
  file << "nframes" << static_cast<int>(calibration.views.size()) << "avg_reprojection_error" << calibration.rms_px;
  return file.releaseAndGetString();
}

std::string camera_text(const CameraModel& camera, const std::string& path) {
  cv::FileStorage file = memory_file(path);
  write_camera(file, camera);
  return file.releaseAndGetString();
}

std::string calibration_text(const Calibration& calibration) {
  std::string text = "  frame  points  error px  tilt deg\n";
  for (const ViewFit& fit : calibration.views)
    text += padded(std::to_string(fit.view.frame), 7) + padded(std::to_string(fit.view.points_px.size()), 8) +
            padded(fixed_text(fit.rms_px, 3), 10) + padded(fixed_text(fit.tilt_deg, 0), 10) + '\n';
  for (const RejectedView& view : calibration.rejected)
    text += padded(std::to_string(view.frame), 7) + "       -" + padded(fixed_text(view.rms_px, 3), 10) +
            "  rejected: more than 3 times the middle error\n";
  const CameraModel &camera = calibration.camera, &deviation = calibration.deviation;
  text += "focal length     " + with_deviation("fx", camera.fx_px, deviation.fx_px, 2) + ", " +
          with_deviation("fy", camera.fy_px, deviation.fy_px, 2) + " px\n";
  text += "principal point  " + with_deviation("cx", camera.cx_px, deviation.cx_px, 2) + ", " +
          with_deviation("cy", camera.cy_px, deviation.cy_px, 2) + " px\n";
  text += "distortion       ";
  const int count = coefficient_count(calibration.lens);
  for (int i = 0; i < count; ++i)
    text += (i > 0 ? ", " : "") + with_deviation(kCoefficients[i], camera.distortion[i], deviation.distortion[i], 5);
  text += count == 0 ? "none\n" : "\n";
  return text + "error            " + fixed_text(calibration.rms_px, 3) + " px RMS over " +
         counted(calibration.views.size(), "frame") + '\n';
}

std::vector<std::string> calibration_hints(const Calibration& calibration, LensModel most) {
  std::vector<std::string> hints;
  const CameraModel &camera = calibration.camera, &deviation = calibration.deviation;
  if (calibration.rms_px > kLargeRmsPx)
    hints.push_back("the error is " + fixed_text(calibration.rms_px, 1) +
                    " px, where 0.1 to 0.5 is usual: is the board flat, and are its sizes and spacing as printed?");
  if (calibration.views.size() < kGoodViews)
    hints.push_back("only " + std::to_string(calibration.views.size()) + " frames are used; 10 to 40 make the figures sure");
  if (const auto parts = empty_parts(calibration); !parts.empty())
    hints.push_back("the board was hardly seen in the picture's " + joined(parts) + ": there the lens is a guess");
  double tilt_deg = 0;
  for (const ViewFit& fit : calibration.views) tilt_deg = std::max(tilt_deg, fit.tilt_deg);
  if (tilt_deg < kGoodTiltDeg)
    hints.push_back("the board is never tilted more than " + fixed_text(tilt_deg, 0) +
                    " degrees: 30 and more tell the focal length from the distance");
  const double focal = std::max(deviation.fx_px / camera.fx_px, deviation.fy_px / camera.fy_px);
  if (focal > kGoodFocal) hints.push_back("the focal length is only known to " + fixed_text(100 * focal, 1) + " %");
  const double aspect = camera.fx_px / camera.fy_px;
  if (std::abs(aspect - 1) > kUnusualAspect)
    hints.push_back("fx and fy differ by " + fixed_text(100 * std::abs(aspect - 1), 0) +
                    " %, where pixels are square in nearly every camera: film more views before trusting this");
  const double center_px = std::max(deviation.cx_px, deviation.cy_px);
  if (center_px > kGoodCenter * camera.width_px)
    hints.push_back("the principal point is only known to " + fixed_text(center_px, 0) +
                    " px: tilt the board to several sides and turn it");
  if (const auto names = undetermined_coefficients(calibration, most); !names.empty())
    hints.push_back("these views do not determine " + joined(names) +
                    (coefficient_count(calibration.lens) < coefficient_count(most) ? "; what is left out is 0" : ""));
  return hints;
}

}  // namespace catchlight::app
