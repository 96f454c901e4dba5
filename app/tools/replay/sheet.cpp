#include "app/tools/replay/sheet.hpp"

#include <opencv2/core.hpp>

#include "app/support/output_file.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {

cv::Mat sheet_row(const cv::Mat& plate, const cv::Mat& ours, const cv::Mat& truth) {
  constexpr double kGain = 8;
  cv::Mat difference, row;
  cv::absdiff(ours, truth, difference);
  difference *= kGain;
  cv::hconcat(std::vector<cv::Mat>{plate, ours, truth, difference}, row);
  return row;
}

void write_sheet(const std::string& path, const std::vector<cv::Mat>& rows) {
  PendingFile file = pending_output(path, true);
  cv::Mat sheet;
  cv::vconcat(rows, sheet);
  render::write_png(file.pending_path(), sheet);
  file.commit();
}

}  // namespace catchlight::app
