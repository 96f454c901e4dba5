#include "app/tools/replay/replay_pictures.hpp"

#include <opencv2/imgproc.hpp>

#include "catchlight/error.hpp"
#include "catchlight/plate.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {

cv::Mat bgr_of(const Frame& frame) {
  std::vector<unsigned char> codes = codes_8_bit(frame.rgb({0, 0, frame.width_px(), frame.height_px()}));
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(frame.height_px(), frame.width_px(), CV_8UC3, codes.data()), bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

cv::Mat composited_bgr(const FrameJob& job) {
  return bgr_of(job.result.rect.empty() ? job.image : job.image.with_composite(job.result));
}

cv::Mat read_bgr(const std::string& path, const cv::Size& size) {
  cv::Mat image = render::read_picture(path, render::PictureDepth::eight_bits);
  if (image.size() != size)
    throw Error(path + ": is " + std::to_string(image.cols) + "x" + std::to_string(image.rows) + ", the footage is " +
                std::to_string(size.width) + "x" + std::to_string(size.height));
  return image;
}

}  // namespace catchlight::app
