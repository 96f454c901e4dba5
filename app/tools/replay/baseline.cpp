#include "app/tools/replay/baseline.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/support/output_file.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/statistics.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {

namespace fs = std::filesystem;

namespace {

cv::Vec3b absolute_difference(const cv::Vec3b& a, const cv::Vec3b& b) {
  cv::Vec3b result;
  for (int c = 0; c < 3; ++c) result[c] = static_cast<std::uint8_t>(std::abs(int{a[c]} - int{b[c]}));
  return result;
}

}  // namespace

KeptDifference compare_with_kept(const cv::Mat& ours, const cv::Mat& kept, const cv::Mat& plate) {
  std::vector<std::uint8_t> largest;
  for (int y = 0; y < ours.rows; ++y)
    for (int x = 0; x < ours.cols; ++x) {
      const auto &a = ours.at<cv::Vec3b>(y, x), &b = kept.at<cv::Vec3b>(y, x), &untouched = plate.at<cv::Vec3b>(y, x);
      if (a == untouched && b == untouched) continue;
      const cv::Vec3b apart = absolute_difference(a, b);
      largest.push_back(std::max({apart[0], apart[1], apart[2]}));
    }
  if (largest.empty()) return {};
  double sum = 0;
  for (const std::uint8_t value : largest) sum += value;
  const double mean = sum / static_cast<double>(largest.size());
  return {mean, static_cast<double>(quantile(std::move(largest), 0.99))};
}

Baseline::Baseline(const std::string& recording_folder)
    : folder_((fs::path(recording_folder) / "baseline").string()), track_file_((fs::path(folder_) / "track.csv").string()) {}

bool Baseline::is_kept() const {
  return fs::exists(track_file_);
}

std::string Baseline::picture(std::int64_t frame) const {
  char name[32];
  std::snprintf(name, sizeof name, "%04lld.png", static_cast<long long>(frame));
  return (fs::path(folder_) / name).string();
}

bool Baseline::has_picture(std::int64_t frame) const {
  return fs::exists(picture(frame));
}

std::vector<std::int64_t> Baseline::keep(const std::vector<TrackRow>& rows) const {
  std::vector<std::int64_t> posed, chosen;
  for (const TrackRow& row : rows) {
    if (row.found) posed.push_back(row.frame);
    if (has_picture(row.frame)) chosen.push_back(row.frame);
  }
  if (posed.empty())
    throw Error(fs::path(folder_).parent_path().string() + ": the tag is found in no frame, so there is nothing to keep");
  make_output_folder(folder_);
  write_text_file(track_file_, tracking::track_file_text(rows), true);
  if (!chosen.empty()) return chosen;
  chosen = {posed.front(), posed[posed.size() / 2], posed.back()};
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

}  // namespace catchlight::app
