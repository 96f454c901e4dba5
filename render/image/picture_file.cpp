#include "render/image/picture_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "catchlight/error.hpp"
#include "render/image/picture_formats.hpp"

namespace catchlight::render {
namespace {

bool starts_with(std::span<const std::uint8_t> bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::equal(text.begin(), text.end(), bytes.begin(),
                                                   [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

StoredPicture decode_stored(std::span<const std::uint8_t> file, const PictureWish& wish) {
  if (starts_with(file, "\x89PNG")) return decode_png(file, wish);
  if (starts_with(file, "\xff\xd8")) return decode_jpeg(file, wish);
  if (starts_with(file, "II*") || starts_with(file, "MM")) return decode_tiff(file);
  throw Error("is neither PNG nor JPEG nor TIFF");
}

// EXIF's orientations: from 5 on rows and columns are exchanged; then 2 and 7 (3 and 6, 4 and 5 likewise) differ in mirroring.
cv::Mat upright(const cv::Mat& picture, int orientation) {
  constexpr int kBoth = -1, kVertical = 0, kHorizontal = 1;
  cv::Mat turned = picture;
  if (orientation >= 5 && orientation <= 8) cv::transpose(picture, turned);
  if (orientation == 2 || orientation == 6) cv::flip(turned, turned, kHorizontal);
  if (orientation == 3 || orientation == 7) cv::flip(turned, turned, kBoth);
  if (orientation == 4 || orientation == 8) cv::flip(turned, turned, kVertical);
  return turned;
}

cv::Mat upper_bytes(const cv::Mat& picture) {
  if (picture.depth() == CV_8U) return picture;
  if (picture.depth() != CV_16U) throw Error("has floats; expected 8 or 16 bits");
  cv::Mat bytes(picture.size(), CV_8UC(picture.channels()));
  const std::size_t row_codes = std::size_t(picture.channels()) * picture.cols;
  for (int y = 0; y < picture.rows; ++y)
    std::transform(picture.ptr<std::uint16_t>(y), picture.ptr<std::uint16_t>(y) + row_codes, bytes.ptr<std::uint8_t>(y),
                   [](std::uint16_t code) { return static_cast<std::uint8_t>(code >> 8); });
  return bytes;
}

}  // namespace

void check_picture_size(double width, double height) {
  if (width < 1 || height < 1 || width * height > kMaxPicturePixels) throw Error("is damaged or too large");
}

cv::Mat decode_picture(std::span<const std::uint8_t> file, PictureDepth depth) {
  const StoredPicture stored = decode_stored(file, {});
  const cv::Mat picture = upright(stored.pixels, stored.orientation);
  return depth == PictureDepth::stored ? picture : upper_bytes(picture);
}

ClearPicture decode_clear_picture(std::span<const std::uint8_t> file, int max_side) {
  const StoredPicture stored = decode_stored(file, {.with_opacity = true, .max_side = max_side});
  cv::Mat picture = upper_bytes(upright(stored.pixels, stored.orientation));
  const double scale = static_cast<double>(max_side) / std::max(picture.cols, picture.rows);
  if (scale < 1) {
    const auto side = [scale](int length) { return std::max(static_cast<int>(scale * length), 1); };
    cv::resize(picture, picture, cv::Size(side(picture.cols), side(picture.rows)), 0, 0, cv::INTER_AREA);
  }
  if (picture.channels() == 3) cv::cvtColor(picture, picture, cv::COLOR_BGR2BGRA);
  return {picture, stored.file_size};
}

cv::Mat read_picture(const std::string& path, PictureDepth depth) {
  std::error_code ignored;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path, ignored)) throw Error(path + ": cannot be opened; expected a picture");
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  try {
    return decode_picture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, depth);
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
}

void write_png(const std::string& path, const cv::Mat& picture) {
  const std::vector<std::uint8_t> png = encode_png(picture);
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  out.close();
  if (!out) throw Error("cannot write " + path + "; is the disk full?");
}

}  // namespace catchlight::render
