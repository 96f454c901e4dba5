#include "app/tools/replay/replay_pictures.hpp"

#include <opencv2/imgproc.hpp>

#include "catchlight/error.hpp"
#include "catchlight/plate.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {

cv::Mat bgr_of(const Frame& frame) {
  const Plate plate = frame.rgb({0, 0, frame.width_px(), frame.height_px()});
  const int depth = plate.format == Plate::Format::rgb_u8    ? CV_8UC3
                    : plate.format == Plate::Format::rgb_u16 ? CV_16UC3
                                                             : CV_32FC3;
  const double to_8_bit = depth == CV_8UC3 ? 1.0 : depth == CV_16UC3 ? 1.0 / 257 : 255.0;
  const cv::Mat codes(plate.rect.height, plate.rect.width, depth, const_cast<std::byte*>(plate.pixels.data()));
  cv::Mat bgr;
  cv::cvtColor(codes, bgr, cv::COLOR_RGB2BGR);
  bgr.convertTo(bgr, CV_8U, to_8_bit);
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
