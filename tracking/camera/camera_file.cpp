#include "tracking/camera/camera_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "tracking/camera/text_tree.hpp"

namespace catchlight::tracking {
namespace {

/// What programs call the same thing, the best name first. Capitals and underscores make no difference.
using Names = std::vector<std::string>;
const Names kWidth{"image_width", "width"}, kHeight{"image_height", "height"}, kSize{"image_size", "resolution"},  // width first
    kMatrix{"camera_matrix", "mtx", "K", "intrinsic_matrix", "intrinsics"},
    kDistortion{
        "distortion_coefficients", "distortion_coeffs", "dist_coeffs", "dist_coeff", "dist_coefs", "dist", "distortion", "D"};

std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name)
    if (c != '_') text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// A value of the file, under the name that it has there.
struct Entry {
  std::string key;
  const TextNode* node = nullptr;
};

std::optional<Entry> find_entry(const TextNode& map, const Names& names) {
  for (const std::string& name : names)
    for (std::size_t i = 0; i < map.keys.size(); ++i)
      if (plain(map.keys[i]) == plain(name)) return Entry{map.keys[i], &map.items[i]};
  return {};
}

/// One file's values, each checked where it is read.
class CameraFile {
 public:
  explicit CameraFile(const std::string& path) : path_(path), tree_(read_text_tree(path)), map_(camera_map()) {}

  [[noreturn]] void refuse(const std::string& key, const std::string& why) const { throw Error(path_ + ": " + key + ": " + why); }

  bool has(const Names& names) const { return find_entry(*map_, names).has_value(); }

  Entry require(const Names& names) const {
    if (const auto entry = find_entry(*map_, names)) return *entry;
    refuse(names.front(), "is missing");
  }

  std::string text(const std::string& key) const {
    const Entry entry = require({key});
    if (entry.node->kind != TextNode::Kind::value) refuse(key, "expected a name");
    return entry.node->text;
  }

  int pixels(const std::string& key, double value) const {
    if (!(value >= 1 && value <= 65536) || value != std::floor(value))
      refuse(key, "expected a whole number of pixels from 1 to 65536");
    return static_cast<int>(value);
  }

  /// A matrix as OpenCV writes it (!!opencv-matrix) and ROS does (a map of rows, cols and data), or lists of numbers within
  /// lists.
  std::vector<double> numbers(const Entry& entry) const {
    std::vector<double> values;
    if (entry.node->kind != TextNode::Kind::map) {
      add_numbers(entry.key, *entry.node, values);
      return values;
    }
    const TextNode *data = entry.node->find("data"), *rows = entry.node->find("rows"), *cols = entry.node->find("cols");
    if (!data || !rows || !cols || data->kind != TextNode::Kind::list)
      refuse(entry.key, "expected a matrix with rows, cols and data, or lists of numbers");
    add_numbers(entry.key, *data, values);
    std::vector<double> shape;
    add_numbers(entry.key, *rows, shape);
    add_numbers(entry.key, *cols, shape);
    if (shape.size() != 2 || shape[0] * shape[1] != static_cast<double>(values.size()))
      refuse(entry.key, "rows times cols is not the number of values in data, " + std::to_string(values.size()));
    return values;
  }

 private:
  /// The map that holds the camera: the whole file, or the one member that has a camera's keys (Kalibr's "cam0").
  const TextNode* camera_map() const {
    const auto is_camera = [](const TextNode& node) { return find_entry(node, kMatrix).has_value(); };
    if (is_camera(tree_)) return &tree_;
    const auto count = std::count_if(tree_.items.begin(), tree_.items.end(), is_camera);
    if (count > 1) throw Error(path_ + ": holds " + std::to_string(count) + " cameras; leave one of them in a copy of the file");
    if (count == 1) return &*std::find_if(tree_.items.begin(), tree_.items.end(), is_camera);
    if (tree_.kind == TextNode::Kind::map && (find_entry(tree_, kWidth) || find_entry(tree_, kDistortion))) return &tree_;
    throw Error(path_ +
                ": is not a camera file; expected image_width, image_height, camera_matrix and distortion_coefficients, as YAML, "
                "JSON or XML");
  }

  /// Numbers of a value (NumPy prints several of them, with spaces and brackets) or of a list's members.
  void add_numbers(const std::string& key, const TextNode& node, std::vector<double>& values) const {
    if (node.kind == TextNode::Kind::map) refuse(key, "expected numbers");
    for (const TextNode& item : node.items) add_numbers(key, item, values);
    if (node.kind == TextNode::Kind::list) return;
    std::string spaced = node.text;
    std::replace_if(
        spaced.begin(), spaced.end(), [](char c) { return std::string_view("[](),\n\t").find(c) != std::string_view::npos; },
        ' ');
    bool any = false;
    for (const std::string& word : split(spaced, ' ')) {
      if (word.empty()) continue;
      values.push_back(number(key, word));
      any = true;
    }
    if (!any) refuse(key, "expected numbers");
  }

  double number(const std::string& key, const std::string& word) const {
    const auto value = real_from_text(word.starts_with('+') ? std::string_view(word).substr(1) : word);
    if (plain(word).ends_with("nan") || plain(word).ends_with("inf") || (value && !std::isfinite(*value)))
      refuse(key, "expected finite numbers, found NaN or infinity");
    if (!value) refuse(key, "expected numbers, found '" + word + "'");
    return *value;
  }

  std::string path_;
  TextNode tree_;
  const TextNode* map_;
};

/// Width and height; none where the file says neither.
void read_size(const CameraFile& file, CameraModel& camera) {
  if (file.has(kSize)) {
    const Entry entry = file.require(kSize);
    const std::vector<double> size = file.numbers(entry);
    if (size.size() != 2) file.refuse(entry.key, "expected width and height");
    camera.width_px = file.pixels(entry.key, size[0]);
    camera.height_px = file.pixels(entry.key, size[1]);
    return;
  }
  if (!file.has(kWidth) && !file.has(kHeight)) return;
  const auto pixels = [&](const Names& names) {
    const Entry entry = file.require(names);
    const std::vector<double> values = file.numbers(entry);
    return file.pixels(entry.key, values.size() == 1 ? values[0] : 0);
  };
  camera.width_px = pixels(kWidth);
  camera.height_px = pixels(kHeight);
}

void check_model(const CameraFile& file, const std::string& key, const Names& supported) {
  if (!file.has({key})) return;
  const std::string model = file.text(key);
  if (std::find(supported.begin(), supported.end(), model) == supported.end())
    file.refuse(key, "'" + model + "' is not supported; calibrate with " + quoted_list(supported));
}

void read_intrinsics(const CameraFile& file, CameraModel& camera) {
  const Entry entry = file.require(kMatrix);
  const std::string& key = entry.key;
  std::vector<double> k = file.numbers(entry);
  if (k.size() == 4 && entry.node->kind == TextNode::Kind::list) {  // Kalibr: fx fy cx cy
    check_model(file, "camera_model", {"pinhole"});
    k = {k[0], 0, k[2], 0, k[1], k[3], 0, 0, 1};
  }
  if (k.size() != 9) file.refuse(key, "expected 3x3 values, found " + std::to_string(k.size()));
  if (!(k[0] > 0) || !(k[4] > 0)) file.refuse(key, "expected positive focal lengths at (0,0) and (1,1)");
  if (k[1] != 0) file.refuse(key, "expected no skew: 0 at (0,1); calibrate without it");
  if (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) file.refuse(key, "expected the form [fx 0 cx; 0 fy cy; 0 0 1]");
  camera.fx_px = k[0];
  camera.fy_px = k[4];
  camera.cx_px = k[2];
  camera.cy_px = k[5];
}

void read_distortion(const CameraFile& file, CameraModel& camera) {
  const Entry entry = file.require(kDistortion);
  const std::string& key = entry.key;
  const std::vector<double> k = file.numbers(entry);
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
  if (!file.has({key})) return;
  const Entry entry = file.require({key});
  if (entry.node->kind != TextNode::Kind::list) file.refuse(key, "expected a list of numbers in brackets");
  const std::vector<double> v = file.numbers(entry);
  if (v.size() != 3) file.refuse(key, "expected three numbers [v1, v2, v3], found " + std::to_string(v.size()));
  for (int i = 1; i <= 10; ++i) {
    const double r2 = i / 10.0, passed = 1 + r2 * (v[0] + r2 * (v[1] + r2 * v[2]));
    if (!(passed > 0)) file.refuse(key, "expected 1 + v1 r^2 + v2 r^4 + v3 r^6 to stay above 0 up to the corners, r = 1");
  }
  camera.vignetting = {v[0], v[1], v[2]};
}

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

/// Whether one size is the other scaled, rounded to whole pixels or even ones.
bool is_same_aspect(const CameraModel& camera, int width_px, int height_px) {
  constexpr double kMaxRoundingPx = 2;
  const double scale = static_cast<double>(height_px) / camera.height_px;
  return std::abs(width_px - camera.width_px * scale) < kMaxRoundingPx * std::max(1.0, scale);
}

/// Pictures as wide and high as these, resampled from those of `camera` (edge to edge).
CameraModel resized(CameraModel camera, int width_px, int height_px) {
  const double x = static_cast<double>(width_px) / camera.width_px, y = static_cast<double>(height_px) / camera.height_px;
  camera.fx_px *= x;
  camera.fy_px *= y;
  camera.cx_px = (camera.cx_px + 0.5) * x - 0.5;
  camera.cy_px = (camera.cy_px + 0.5) * y - 0.5;
  camera.width_px = width_px;
  camera.height_px = height_px;
  return camera;
}

/// Whether a camera of unknown size may be one for pictures of this size.
bool has_central_principal_point(const CameraModel& camera, int width_px, int height_px) {
  constexpr double kMaxOff = 0.1;
  return std::abs(camera.cx_px / width_px - 0.5) < kMaxOff && std::abs(camera.cy_px / height_px - 0.5) < kMaxOff;
}

}  // namespace

CameraModel read_camera_file(const std::string& path) {
  const CameraFile file(path);
  CameraModel camera;
  read_size(file, camera);
  read_intrinsics(file, camera);
  check_model(file, "distortion_model", {"plumb_bob", "rational_polynomial", "radtan"});
  read_distortion(file, camera);
  read_vignetting(file, camera);
  return camera;
}

CameraModel read_camera_file_for(const std::string& path, const std::string& pictures, int width_px, int height_px,
                                 const WarningHandler& warn) {
  CameraModel camera = read_camera_file(path);
  const std::string wanted = size_text(width_px, height_px), own = size_text(camera.width_px, camera.height_px);
  if (camera.width_px == 0) {
    if (!has_central_principal_point(camera, width_px, height_px))
      throw Error(path + ": says no size, and its principal point (" + fixed_text(camera.cx_px, 1) + ", " +
                  fixed_text(camera.cy_px, 1) + ") is not that of pictures of " + wanted +
                  "; add image_width and image_height of the pictures that it was calibrated with");
    if (warn) warn(path + ": says no size; taken to be for pictures of " + wanted + " (add image_width and image_height)");
    camera.width_px = width_px;
    camera.height_px = height_px;
  }
  if (camera.width_px == width_px && camera.height_px == height_px) return camera;
  if (!is_same_aspect(camera, width_px, height_px))
    throw Error(path + ": is for pictures of " + own + ", but " + pictures + " is " + wanted +
                ", another aspect, so that one of them shows a part only; calibrate with pictures taken as these were, or pass "
                "another --camera or --fov");
  if (warn)
    warn(path + ": is for pictures of " + own + "; scaled to " + wanted +
         ", which is right where the camera scales too, and wrong where it cuts a part out");
  return resized(camera, width_px, height_px);
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

double horizontal_fov_deg(const CameraModel& camera) {
  return 2 * glm::degrees(std::atan(camera.width_px / (2 * camera.fx_px)));
}

}  // namespace catchlight::tracking
