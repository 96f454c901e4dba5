#include "tracking/track_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "catchlight/error.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::tracking {
namespace {

constexpr std::array<const char*, 12> kPoseColumns{"r00", "r01", "r02", "r10", "r11", "r12",
                                                   "r20", "r21", "r22", "tx",  "ty",  "tz"};
constexpr double kRotationTolerance = 1e-3;

/// What the covariance's rows and columns are of.
constexpr std::array<const char*, 6> kPoseFreedoms{"rx", "ry", "rz", "tx", "ty", "tz"};
constexpr const char* kSubjectColumns = ",width_px,height_px,fx_px,fy_px,cx_px,cy_px,distortion,tag_family,tag_id,tag_size_m";

/// Calls with each column of the covariance's upper triangle, which is all of it, and its row and column.
template <class Each>
void for_each_covariance_column(Each&& each) {
  for (std::size_t row = 0; row < kPoseFreedoms.size(); ++row)
    for (std::size_t column = row; column < kPoseFreedoms.size(); ++column)
      each(std::string("cov_") + kPoseFreedoms[row] + '_' + kPoseFreedoms[column], row, column);
}

/// The pose in the order of kPoseColumns; glm keeps columns.
std::array<double, 12> pose_cells(const RigidTransform& pose) {
  std::array<double, 12> cells;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) cells[static_cast<std::size_t>(3 * row + column)] = pose.rotation[column][row];
    cells[static_cast<std::size_t>(9 + row)] = pose.translation_m[row];
  }
  return cells;
}

RigidTransform pose_from_cells(const std::array<double, 12>& cells) {
  RigidTransform pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose.rotation[column][row] = cells[static_cast<std::size_t>(3 * row + column)];
    pose.translation_m[row] = cells[static_cast<std::size_t>(9 + row)];
  }
  return pose;
}

/// Orthonormal columns, right-handed.
bool is_rotation(const glm::dmat3& m) {
  const glm::dmat3 product = glm::transpose(m) * m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(product[i][j] - (i == j ? 1.0 : 0.0)) > kRotationTolerance) return false;
  return glm::determinant(m) > 0;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw Error(path + ": cannot open the track file; does it exist, and may it be read?");
    read_header();
  }

  TrackFile read() {
    TrackFile file;
    std::vector<TrackRow>& rows = file.rows;
    while (next_line()) {
      if (cells_.size() == 1 && cells_[0].empty()) continue;
      if (cells_.size() != column_count_)
        fail("has " + std::to_string(cells_.size()) + " fields; the first line names " + std::to_string(column_count_));
      const TrackRow row = parse_row();
      if (!rows.empty() && row.frame <= rows.back().frame)
        fail("frame " + std::to_string(row.frame) + " after frame " + std::to_string(rows.back().frame) +
             "; expected rising order");
      if (rows.empty() && cell("fx_px") && !cell("fx_px")->empty()) file.subject = subject();
      file.has_times |= row.time_s != 0;
      rows.push_back(row);
    }
    return file;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw Error(path_ + ':' + std::to_string(line_) + ": " + message); }

  bool next_line() {
    std::string text;
    if (!std::getline(file_, text)) return false;
    ++line_;
    if (text.ends_with('\r')) text.pop_back();
    cells_ = split(text, separator_);
    if (separator_ == ';')  // where it is one, numbers may have decimal commas
      for (std::string& cell : cells_) std::replace(cell.begin(), cell.end(), ',', '.');
    return true;
  }

  void read_header() {
    line_ = 1;
    std::string text;
    std::getline(file_, text);
    if (text.ends_with('\r')) text.pop_back();
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    if (text.find(',') == std::string::npos && text.find(';') != std::string::npos) separator_ = ';';
    const std::vector<std::string> names = split(text, separator_);
    column_count_ = names.size();
    for (std::size_t i = 0; i < names.size(); ++i)
      if (!columns_.emplace(names[i], i).second) fail("column '" + names[i] + "' is named twice");
    if (!columns_.contains("frame"))
      fail("no column 'frame'; expected a track file, whose first line begins frame,time_s,found,r00");
  }

  /// Null where the file has no such column.
  const std::string* cell(const std::string& column) const {
    const auto found = columns_.find(column);
    return found == columns_.end() ? nullptr : &cells_[found->second];
  }

  double finite_number(const std::string& column) const {
    const std::string* text = cell(column);
    if (!text) fail("no column '" + column + "', which a frame with a pose needs");
    const std::optional<double> number = real_from_text(*text);
    if (!number || !std::isfinite(*number)) fail("column '" + column + "' is \"" + *text + "\"; expected a finite number");
    return *number;
  }

  double number_or(const std::string& column, double fallback) const { return cell(column) ? finite_number(column) : fallback; }

  glm::dvec3 rgb_or(const std::string& name, const glm::dvec3& fallback) const {
    return {number_or(name + "_r", fallback.r), number_or(name + "_g", fallback.g), number_or(name + "_b", fallback.b)};
  }

  std::int64_t frame() const {
    const std::string& text = *cell("frame");
    const std::optional<std::int64_t> number = integer_from_text(text);
    if (!number || *number < 0) fail("column 'frame' is \"" + text + "\"; expected a whole number from 0");
    return *number;
  }

  bool found() const {
    const std::string* text = cell("found");
    if (text && *text != "0" && *text != "1") fail("column 'found' is \"" + *text + "\"; expected 0 or 1");
    return !text || *text == "1";
  }

  TrackState state(bool is_found) const {
    const std::string* text = cell("state");
    if (!text) return is_found ? TrackState::tracking : TrackState::lost;
    const auto state = value_named<TrackState>(*text);
    if (state && is_found == (*state != TrackState::lost)) return *state;
    fail("column 'state' is \"" + *text + "\"; expected " +
         (is_found ? "tracking or coasting, as found is 1" : "lost, as found is 0"));
  }

  RigidTransform pose() const {
    std::array<double, 12> cells;
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = finite_number(kPoseColumns[i]);
    const RigidTransform pose = pose_from_cells(cells);
    if (!is_rotation(pose.rotation))
      fail("r00 .. r22 are not a rotation: expected orthonormal rows within 0.001 and determinant 1");
    return pose;
  }

  std::optional<PoseCovariance> covariance() const {
    if (!cell("cov_rx_rx") || cell("cov_rx_rx")->empty()) return std::nullopt;
    PoseCovariance covariance{};
    for_each_covariance_column([&](const std::string& name, std::size_t row, std::size_t column) {
      covariance[6 * row + column] = covariance[6 * column + row] = finite_number(name);
    });
    return covariance;
  }

  std::string text(const std::string& column) const {
    if (!cell(column)) fail("no column '" + column + "', which one with 'fx_px' needs");
    return *cell(column);
  }

  int whole_number(const std::string& column) const {
    const std::optional<std::int64_t> number = integer_from_text(text(column));
    if (!number || *number < 0 || *number > std::numeric_limits<int>::max())
      fail("column '" + column + "' is \"" + text(column) + "\"; expected a whole number from 0");
    return static_cast<int>(*number);
  }

  TrackSubject subject() const {
    TrackSubject subject;
    CameraModel& camera = subject.camera;
    camera.width_px = whole_number("width_px");
    camera.height_px = whole_number("height_px");
    camera.fx_px = finite_number("fx_px"), camera.fy_px = finite_number("fy_px");
    camera.cx_px = finite_number("cx_px"), camera.cy_px = finite_number("cy_px");
    const std::vector<std::string> coefficients = split(text("distortion"), ' ');
    for (std::size_t i = 0; i < std::min(coefficients.size(), camera.distortion.size()); ++i) {
      const std::optional<double> number = real_from_text(coefficients[i]);
      if (!number || !std::isfinite(*number))
        fail("column 'distortion' is \"" + text("distortion") + "\"; expected eight numbers");
      camera.distortion[i] = *number;
    }
    subject.tag = {text("tag_family"), whole_number("tag_id"), finite_number("tag_size_m")};
    return subject;
  }

  TrackRow parse_row() const {
    TrackRow row;
    row.frame = frame();
    row.time_s = number_or("time_s", 0);
    row.found = found();
    row.state = state(row.found);
    if (row.found) row.camera_from_tag = pose();
    if (row.found) row.pose_covariance = covariance();
    row.has_exposure = cell("exposure_r") != nullptr;
    row.exposure = rgb_or("exposure", row.exposure);
    row.black = rgb_or("black", row.black);
    row.corner_sigma_px = number_or("corner_sigma_px", 0);
    row.ambiguity = number_or("ambiguity", 0);
    row.blur_px2 = {number_or("blur_xx_px2", 0), number_or("blur_xy_px2", 0), number_or("blur_yy_px2", 0)};
    row.noise_codes = number_or("noise_codes", 0);
    row.noise.slope = rgb_or("noise_slope", row.noise.slope);
    row.noise.floor = rgb_or("noise_floor", row.noise.floor);
    row.noise.correlation = {number_or("noise_correlation_rg", 0), number_or("noise_correlation_rb", 0),
                             number_or("noise_correlation_gb", 0)};
    const auto vector = [&](const std::string& name) {
      return glm::dvec3(number_or(name + "_x", 0), number_or(name + "_y", 0), number_or(name + "_z", 0));
    };
    row.blur = {{vector("turn"), vector("shift")},
                number_or("shutter", 0),
                number_or("focus_px2", 0),
                {number_or("shake_x", 0), number_or("shake_y", 0)}};
    return row;
  }

  std::string path_;
  std::ifstream file_;
  std::size_t line_ = 0, column_count_ = 0;
  char separator_ = ',';
  std::map<std::string, std::size_t> columns_;
  std::vector<std::string> cells_;
};

std::string header_text(bool has_subject) {
  std::string text = "frame,time_s,found";
  for (const char* column : kPoseColumns) text += std::string(",") + column;
  text +=
      ",state,exposure_r,exposure_g,exposure_b,black_r,black_g,black_b,corner_sigma_px,ambiguity,"
      "blur_xx_px2,blur_xy_px2,blur_yy_px2,noise_codes,noise_slope_r,noise_slope_g,noise_slope_b,noise_floor_r,noise_floor_g,"
      "noise_floor_b,noise_correlation_rg,noise_correlation_rb,noise_correlation_gb,"
      "turn_x,turn_y,turn_z,shift_x,shift_y,shift_z,shutter,focus_px2,shake_x,shake_y";
  for_each_covariance_column([&](const std::string& name, std::size_t, std::size_t) { text += ',' + name; });
  return text + (has_subject ? kSubjectColumns : "") + '\n';
}

std::string covariance_text(const TrackRow& row) {
  std::string text;
  for_each_covariance_column([&](const std::string&, std::size_t i, std::size_t j) {
    text += ',' + (row.found && row.pose_covariance ? number_text((*row.pose_covariance)[6 * i + j]) : "");
  });
  return text;
}

/// The cells of kSubjectColumns.
std::string subject_text(const TrackSubject& subject) {
  const CameraModel& camera = subject.camera;
  std::string text = ',' + std::to_string(camera.width_px) + ',' + std::to_string(camera.height_px);
  for (const double number : {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px}) text += ',' + number_text(number);
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) text += (i == 0 ? ',' : ' ') + number_text(camera.distortion[i]);
  return text + ',' + subject.tag.family + ',' + std::to_string(subject.tag.id) + ',' + number_text(subject.tag.size_m);
}

std::string row_text(const TrackRow& row) {
  std::string text = std::to_string(row.frame) + ',' + number_text(row.time_s) + (row.found ? ",1" : ",0");
  for (const double cell : pose_cells(row.camera_from_tag)) text += ',' + (row.found ? number_text(cell) : "");
  text += ',' + name_of(row.state);
  for (const glm::dvec3& rgb : {row.exposure, row.black})
    for (int i = 0; i < 3; ++i) text += ',' + number_text(rgb[i]);
  const Covariance2& blur = row.blur_px2;
  for (const double number : {row.corner_sigma_px, row.ambiguity, blur.xx, blur.xy, blur.yy, row.noise_codes})
    text += ',' + number_text(number);
  const TagMotion& motion = row.blur.motion;
  for (const glm::dvec3& three : {row.noise.slope, row.noise.floor, row.noise.correlation, motion.turn_rad, motion.shift_m})
    for (int i = 0; i < 3; ++i) text += ',' + number_text(three[i]);
  const glm::dvec2& shake = row.blur.shake_rad;
  for (const double number : {row.blur.shutter, row.blur.focus_px2, shake.x, shake.y}) text += ',' + number_text(number);
  return text + covariance_text(row);
}

}  // namespace

TrackFile read_track_file(const std::string& path) {
  return Reader(path).read();
}

std::string track_file_text(const std::vector<TrackRow>& rows, const std::optional<TrackSubject>& subject) {
  std::string text = header_text(subject.has_value());
  const std::string constant = subject ? subject_text(*subject) : "";
  for (const TrackRow& row : rows) text += row_text(row) + constant + '\n';
  return text;
}

}  // namespace catchlight::tracking
