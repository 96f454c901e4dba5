#include "render/glare/aperture_picture.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "catchlight/error.hpp"
#include "render/glare/aperture_shapes.hpp"
#include "render/image/image_io.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::render {
namespace {

constexpr int kEndless_px = std::numeric_limits<int>::max();
constexpr std::string_view kBlades = "blades:";
constexpr int kMinBlades = 3, kMaxBlades = 24;

int blades_of(const std::string& name) {
  const char *begin = name.data() + kBlades.size(), *end = name.data() + name.size();
  int blades = 0;
  const auto [stop, error] = std::from_chars(begin, end, blades);
  if (error != std::errc() || stop != end || blades < kMinBlades || blades > kMaxBlades)
    throw Error("aperture \"" + name + "\": expected blades:N with N from " + std::to_string(kMinBlades) + " to " +
                std::to_string(kMaxBlades) + ", as in blades:6");
  return blades;
}

[[noreturn]] void refuse(const std::string& what) {
  throw Error(what + "; an aperture is \"circle\", \"blades:N\", \"eyelashes\", \"dust\" or a square picture, " +
              "white where light passes");
}

Image read_colors(const std::string& path) {
  if (std::filesystem::path(path).extension() == ".exr") return read_exr(path);
  cv::Mat codes;
  try {
    codes = read_picture(path, PictureDepth::stored);
  } catch (const Error& error) {
    refuse(error.what());
  }
  cv::cvtColor(codes, codes, cv::COLOR_BGR2RGB);
  codes.convertTo(codes, CV_32F, codes.depth() == CV_8U ? 1.0 / 255 : codes.depth() == CV_16U ? 1.0 / 65535 : 1.0);
  Image image(codes.cols, codes.rows);
  std::copy_n(codes.ptr<float>(), image.data.size(), image.data.begin());
  return image;
}

Image read_transmission(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) refuse(path + ": no such file");
  const Image colors = read_colors(path);
  if (colors.width != colors.height)
    refuse(path + ": its " + std::to_string(colors.width) + " x " + std::to_string(colors.height) + " pixels are not square");
  Image result(colors.width, colors.height, 1);
  for (std::size_t i = 0; i < result.data.size(); ++i) {
    const float* rgb = &colors.data[i * static_cast<std::size_t>(colors.channels)];
    const float luminance = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
    if (!std::isfinite(luminance) || luminance < 0) refuse(path + ": it has values that are negative, NaN or Inf");
    result.data[i] = luminance;
  }
  const float most = *std::max_element(result.data.begin(), result.data.end());
  if (most <= 0) refuse(path + ": it is black all over, so that no light passes");
  for (float& value : result.data) value /= std::max(most, 1.0f);
  return result;
}

Image shrunk(const Image& image, int size_px) {
  Image result(size_px, size_px, 1);
  const cv::Mat from(image.height, image.width, CV_32FC1, const_cast<float*>(image.data.data()));
  cv::Mat to(size_px, size_px, CV_32FC1, result.data.data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
  return result;
}

}  // namespace

AperturePicture aperture_picture(const std::string& name) {
  if (name == "circle") return {kEndless_px, circle_aperture};
  if (name == "eyelashes") return {kEndless_px, eyelash_aperture};
  if (name == "dust") return {kEndless_px, dusty_aperture};
  if (name.starts_with(kBlades))
    return {kEndless_px, [blades = blades_of(name)](int size_px) { return diaphragm_aperture({.blades = blades}, size_px); }};
  const auto picture = std::make_shared<const Image>(read_transmission(name));
  return {picture->width, [picture](int size_px) { return size_px < picture->width ? shrunk(*picture, size_px) : *picture; }};
}

}  // namespace catchlight::render
