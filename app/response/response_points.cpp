#include "app/response/response_points.hpp"

#include <cmath>
#include <opencv2/core.hpp>
#include <sstream>

#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr std::size_t kMaxPoints = 65536;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(path + ": " + why);
}

[[noreturn]] void refuse(const std::string& path, int line, const std::string& why) {
  refuse(path + ":" + std::to_string(line), why);
}

/// Lines without comments and blank ones, with their numbers.
struct Line {
  int number;
  std::string text;
};

std::vector<Line> lines_of(const std::string& text) {
  std::vector<Line> lines;
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.pop_back();
    if (!line.empty() && line.front() != '#') lines.push_back({number, line});
  }
  return lines;
}

/// Words between spaces and tabs.
std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Empty where any of them is not a finite number.
std::optional<std::vector<double>> numbers_of(const std::vector<std::string>& words) {
  std::vector<double> numbers;
  for (const std::string& word : words) {
    const std::size_t first = word.find_first_not_of(" \t");
    const std::size_t last = word.find_last_not_of(" \t");
    if (first == std::string::npos) return std::nullopt;
    const auto number = real_from_text(std::string_view(word).substr(first, last - first + 1));
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

void check_count(const std::string& path, const ResponsePoints& points) {
  if (points.codes.size() < 2 || points.codes.size() > kMaxPoints)
    refuse(path, "holds " + std::to_string(points.codes.size()) + " codes; expected 2 to " + std::to_string(kMaxPoints));
}

void space_evenly(ResponsePoints& points) {
  const std::size_t count = points.light[0].size();
  for (std::size_t i = 0; i < count; ++i) points.codes.push_back(static_cast<double>(i) / static_cast<double>(count - 1));
}

/// The only matrix of a storage, whatever its name.
cv::Mat only_matrix(const std::string& path, const std::string& text) {
  cv::Mat matrix;
  int found = 0;
  try {
    const cv::FileStorage storage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    for (const cv::FileNode& node : storage.root()) {
      if (!node.isMap() || node["data"].empty()) continue;
      node >> matrix;
      ++found;
    }
  } catch (const cv::Exception&) {
    refuse(path, "is not YAML or XML as cv::FileStorage writes it; a table of codes may be .csv too (docs/exposure.md)");
  }
  if (found != 1)
    refuse(path,
           "holds " + std::to_string(found) +
               " matrices; expected the one that cv::CalibrateDebevec or CalibrateRobertson gave, written by cv::FileStorage");
  return matrix;
}

/// "LUT_1D_SIZE 1024" and the like. Whether it was one.
struct CubeHead {
  std::size_t size = 0;
  std::array<double, 3> low{0, 0, 0}, high{1, 1, 1};
};

bool read_keyword(CubeHead& head, const std::string& path, const Line& line) {
  const std::vector<std::string> words = words_of(line.text);
  const std::string& key = words.front();
  if (key == "TITLE") return true;
  if (key == "LUT_3D_SIZE")
    refuse(path, line.number, "is a 3D LUT, which mixes the channels; expected a 1D LUT from codes to linear light");
  const bool is_domain = key == "DOMAIN_MIN" || key == "DOMAIN_MAX";
  if (key != "LUT_1D_SIZE" && key != "LUT_1D_INPUT_RANGE" && !is_domain) return false;
  const auto numbers = numbers_of({words.begin() + 1, words.end()});
  const std::size_t expected = is_domain ? 3 : key == "LUT_1D_SIZE" ? 1 : 2;
  if (!numbers || numbers->size() != expected)
    refuse(path, line.number, key + " expects " + std::to_string(expected) + " numbers");
  if (key == "LUT_1D_SIZE") head.size = numbers->front() >= 0 ? static_cast<std::size_t>(numbers->front()) : 0;
  if (key == "LUT_1D_INPUT_RANGE") head.low.fill(numbers->front()), head.high.fill(numbers->back());
  for (std::size_t c = 0; is_domain && c < 3; ++c) (key == "DOMAIN_MIN" ? head.low : head.high)[c] = (*numbers)[c];
  return true;
}

}  // namespace

ResponsePoints points_of_storage(const std::string& path, const std::string& text) {
  cv::Mat matrix = only_matrix(path, text);
  const int channels = matrix.channels() * (matrix.rows == 1 ? 1 : matrix.cols);
  if (matrix.dims != 2 || (channels != 1 && channels != 3) || matrix.total() * static_cast<std::size_t>(matrix.channels()) == 0)
    refuse(path, "holds a matrix of " + std::to_string(matrix.rows) + " x " + std::to_string(matrix.cols) + " with " +
                     std::to_string(matrix.channels()) +
                     " channels; expected 256 x 1 with 1 or 3, as OpenCV's calibration gives");
  matrix.convertTo(matrix, CV_64F);
  matrix = matrix.reshape(1, static_cast<int>(matrix.total()) * matrix.channels() / channels);
  ResponsePoints points;
  for (int row = 0; row < matrix.rows; ++row)
    for (int c = 0; c < 3; ++c) {
      const double light = matrix.at<double>(row, channels == 1 ? 0 : 2 - c);  // OpenCV's order is blue first
      if (!std::isfinite(light)) refuse(path, "the light of code " + std::to_string(row) + " is not a finite number");
      points.light[static_cast<std::size_t>(c)].push_back(light);
    }
  space_evenly(points);
  check_count(path, points);
  return points;
}

ResponsePoints points_of_csv(const std::string& path, const std::string& text) {
  ResponsePoints points;
  bool is_first = true;
  for (const Line& line : lines_of(text)) {
    const auto numbers = numbers_of(split(line.text, ','));
    const bool is_heading = is_first && !numbers;
    is_first = false;
    if (is_heading) continue;
    if (!numbers || numbers->size() != 4) refuse(path, line.number, "expected four numbers, code,red,green,blue");
    if (points.codes.empty() ? numbers->front() != 0 : numbers->front() <= points.codes.back())
      refuse(path, line.number, "code " + plain_text(numbers->front()) + "; expected codes that rise from 0");
    points.codes.push_back(numbers->front());
    for (std::size_t c = 0; c < 3; ++c) points.light[c].push_back((*numbers)[c + 1]);
  }
  check_count(path, points);
  const double last = points.codes.back();
  for (double& code : points.codes) code /= last;
  return points;
}

ResponsePoints points_of_cube(const std::string& path, const std::string& text) {
  CubeHead head;
  ResponsePoints points;
  points.is_measured = false;
  for (const Line& line : lines_of(text)) {
    if (read_keyword(head, path, line)) continue;
    const auto numbers = numbers_of(words_of(line.text));
    if (!numbers || numbers->size() != 3) refuse(path, line.number, "expected three numbers, or a keyword of the .cube format");
    for (std::size_t c = 0; c < 3; ++c) points.light[c].push_back((*numbers)[c]);
  }
  if (head.size != points.light[0].size())
    refuse(path, "LUT_1D_SIZE is " + std::to_string(head.size) + ", but " + std::to_string(points.light[0].size()) +
                     " rows follow; expected as many rows as it says");
  for (std::size_t c = 0; c < 3; ++c)
    if (head.low[c] != 0 || head.high[c] != 1)
      refuse(
          path,
          "its codes do not run from 0 to 1 (DOMAIN_MIN, DOMAIN_MAX or LUT_1D_INPUT_RANGE); expected a LUT of the whole range");
  space_evenly(points);
  check_count(path, points);
  return points;
}

}  // namespace catchlight::app
