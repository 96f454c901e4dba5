#include "tracking/camera/camera_file.hpp"

#include <fstream>
#include <numbers>
#include <opencv2/core.hpp>
#include <sstream>
#include <vector>

#include "catchlight/error.hpp"

namespace catchlight::tracking {
namespace {

/// OpenCV's parser wants its own first line, which ROS files lack.
std::string yaml_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path + ": cannot be opened; expected a camera file (OpenCV or ROS YAML)");
  std::ostringstream buffer;
  buffer << file.rdbuf();
  std::string text = buffer.str();
  if (text.empty()) throw Error(path + ": is empty; expected a camera file (OpenCV or ROS YAML)");
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (text.starts_with("%YAML")) return text;
  return "%YAML:1.0\n" + std::string(text.starts_with("---") ? "" : "---\n") + text;
}

cv::FileStorage open_yaml(const std::string& path) {
  const std::string text = yaml_text(path);
  try {
    cv::FileStorage storage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
    if (storage.isOpened() && storage.root().isMap()) return storage;
  } catch (const cv::Exception& exception) {
    throw Error(path + ": is not YAML that OpenCV can read (" + exception.err + ")");
  }
  throw Error(path +
              ": is not a camera file; expected YAML with image_width, image_height, camera_matrix, distortion_coefficients");
}

/// One file's values, each checked where it is read.
class CameraFile {
 public:
  explicit CameraFile(const std::string& path) : path_(path), storage_(open_yaml(path)) {}

  [[noreturn]] void refuse(const std::string& key, const std::string& why) const { throw Error(path_ + ": " + key + ": " + why); }

  bool has(const std::string& key) const { return !storage_[key].empty(); }

  std::string text(const std::string& key) const {
    const cv::FileNode node = storage_[key];
    if (!node.isString()) refuse(key, "expected a name");
    return node.string();
  }

  int positive_integer(const std::string& key) const {
    const double value = number(require(key), key);
    if (!(value >= 1 && value <= 65536) || value != std::floor(value))
      refuse(key, "expected a whole number of pixels from 1 to 65536");
    return static_cast<int>(value);
  }

  /// A matrix as OpenCV writes it (!!opencv-matrix) or as ROS does: a map of rows, cols and data.
  std::vector<double> matrix(const std::string& key) const {
    const cv::FileNode node = require(key);
    if (!node.isMap()) refuse(key, "expected a matrix with rows, cols and data");
    const cv::FileNode data = node["data"];
    if (!data.isSeq()) refuse(key, "expected a matrix with rows, cols and data");
    std::vector<double> values;
    for (const cv::FileNode& element : data) values.push_back(number(element, key));
    const double expected = number(node["rows"], key) * number(node["cols"], key);
    if (expected != static_cast<double>(values.size()))
      refuse(key, "rows times cols is not the number of values in data, " + std::to_string(values.size()));
    return values;
  }

  /// Numbers in brackets.
  std::vector<double> list(const std::string& key) const {
    const cv::FileNode node = require(key);
    if (!node.isSeq()) refuse(key, "expected a list of numbers in brackets");
    std::vector<double> values;
    for (const cv::FileNode& element : node) values.push_back(number(element, key));
    return values;
  }

 private:
  cv::FileNode require(const std::string& key) const {
    const cv::FileNode node = storage_[key];
    if (node.empty()) refuse(key, "is missing");
    return node;
  }

  double number(const cv::FileNode& node, const std::string& key) const {
    if (!node.isReal() && !node.isInt()) refuse(key, "expected numbers");
    const double value = node.real();
    if (!std::isfinite(value)) refuse(key, "expected finite numbers, found NaN or infinity");
    return value;
  }

  std::string path_;
  cv::FileStorage storage_;
};

void read_intrinsics(const CameraFile& file, CameraModel& camera) {
  const std::string key = "camera_matrix";
  const std::vector<double> k = file.matrix(key);
  if (k.size() != 9) file.refuse(key, "expected 3x3 values, found " + std::to_string(k.size()));
  if (!(k[0] > 0) || !(k[4] > 0)) file.refuse(key, "expected positive focal lengths at (0,0) and (1,1)");
  if (k[1] != 0) file.refuse(key, "expected no skew: 0 at (0,1); calibrate without it");
  if (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) file.refuse(key, "expected the form [fx 0 cx; 0 fy cy; 0 0 1]");
  camera.fx_px = k[0];
  camera.fy_px = k[4];
  camera.cx_px = k[2];
  camera.cy_px = k[5];
}

void check_distortion_model(const CameraFile& file) {
  const std::string key = "distortion_model";
  if (!file.has(key)) return;
  const std::string model = file.text(key);
  if (model != "plumb_bob" && model != "rational_polynomial")
    file.refuse(key, "'" + model + "' is not supported; calibrate with plumb_bob or rational_polynomial");
}

void read_distortion(const CameraFile& file, CameraModel& camera) {
  const std::string key = "distortion_coefficients";
  const std::vector<double> k = file.matrix(key);
  if (k.size() != 4 && k.size() != 5 && k.size() != 8 && k.size() != 12 && k.size() != 14)
    file.refuse(key, "expected 4, 5 or 8 coefficients k1 k2 p1 p2 [k3 [k4 k5 k6]], found " + std::to_string(k.size()));
  for (std::size_t i = 0; i < k.size(); ++i) {
    if (i < camera.distortion.size())
      camera.distortion[i] = k[i];
    else if (k[i] != 0)
      file.refuse(key, "thin-prism and tilt coefficients (the 9th on) are not supported; calibrate with 8 or fewer");
  }
}

void read_vignetting(const CameraFile& file, CameraModel& camera) {
  const std::string key = "vignetting";
  if (!file.has(key)) return;
  const std::vector<double> v = file.list(key);
  if (v.size() != 3) file.refuse(key, "expected three numbers [v1, v2, v3], found " + std::to_string(v.size()));
  for (int i = 1; i <= 10; ++i) {
    const double r2 = i / 10.0, passed = 1 + r2 * (v[0] + r2 * (v[1] + r2 * v[2]));
    if (!(passed > 0)) file.refuse(key, "expected 1 + v1 r^2 + v2 r^4 + v3 r^6 to stay above 0 up to the corners, r = 1");
  }
  camera.vignetting = {v[0], v[1], v[2]};
}

}  // namespace

CameraModel read_camera_file(const std::string& path) {
  const CameraFile file(path);
  CameraModel camera;
  camera.width_px = file.positive_integer("image_width");
  camera.height_px = file.positive_integer("image_height");
  read_intrinsics(file, camera);
  check_distortion_model(file);
  read_distortion(file, camera);
  read_vignetting(file, camera);
  return camera;
}

CameraModel camera_from_field_of_view(int width_px, int height_px, double horizontal_fov_deg) {
  if (width_px <= 0 || height_px <= 0) throw Error("a camera needs a positive image size");
  if (!(horizontal_fov_deg > 0 && horizontal_fov_deg < 180))
    throw Error("the horizontal field of view must be between 0 and 180 degrees, not " + std::to_string(horizontal_fov_deg));
  CameraModel camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  // The image spans half a pixel beyond the outer pixels' centres.
  camera.fx_px = camera.fy_px = width_px / 2.0 / std::tan(horizontal_fov_deg * std::numbers::pi / 360);
  camera.cx_px = (width_px - 1) / 2.0;
  camera.cy_px = (height_px - 1) / 2.0;
  return camera;
}

}  // namespace catchlight::tracking
