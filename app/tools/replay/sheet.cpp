#include "app/tools/replay/sheet.hpp"

#include <opencv2/imgcodecs.hpp>

#include "app/support/output_file.hpp"
#include "catchlight/error.hpp"

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
  if (!cv::imwrite(file.pending_path(), sheet)) throw Error("cannot write " + path + "; is the disk full?");
  file.commit();
}

}  // namespace catchlight::app
