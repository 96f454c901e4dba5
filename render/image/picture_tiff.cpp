#include <tiffio.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "catchlight/error.hpp"
#include "render/image/picture_formats.hpp"

namespace catchlight::render {
namespace {

struct Input {
  std::span<const std::uint8_t> bytes;
  toff_t at = 0;
};

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t size) {
  auto& input = *static_cast<Input*>(handle);
  const std::size_t left = input.at < input.bytes.size() ? input.bytes.size() - input.at : 0;
  const std::size_t count = std::min(left, static_cast<std::size_t>(size));
  if (count > 0) std::memcpy(to, input.bytes.data() + input.at, count);
  input.at += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write_nothing(thandle_t, void*, tmsize_t) {
  return 0;
}

toff_t seek(thandle_t handle, toff_t offset, int whence) {
  auto& input = *static_cast<Input*>(handle);
  input.at = offset + (whence == SEEK_CUR ? input.at : whence == SEEK_END ? input.bytes.size() : 0);
  return input.at;
}

int keep_open(thandle_t) {
  return 0;
}

toff_t size_of(thandle_t handle) {
  return static_cast<Input*>(handle)->bytes.size();
}

using TiffPtr = std::unique_ptr<TIFF, void (*)(TIFF*)>;

[[noreturn]] void refuse() {
  throw Error("is a TIFF that is damaged or of an unknown kind");
}

template <typename T>
T field(TIFF* tiff, std::uint32_t tag, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) ? value : otherwise;
}

// Whether the file holds grey or colour channels of 16 bits or floats side by side: what libtiff's own pictures, of 8 bits, lose.
bool is_deep(TIFF* tiff) {
  const auto bits = field<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1),
             kind = field<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, 1);
  const auto channels = field<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  const auto color = field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISWHITE);
  const bool has_format = (bits == 16 && kind == SAMPLEFORMAT_UINT) || (bits == 32 && kind == SAMPLEFORMAT_IEEEFP);
  const bool has_colors = channels >= 3 ? color == PHOTOMETRIC_RGB : color == PHOTOMETRIC_MINISBLACK;
  return has_format && has_colors && !TIFFIsTiled(tiff) &&
         field<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_CONTIG;
}

template <typename T>
cv::Mat deep_pixels(TIFF* tiff, int width, int height, int type) {
  const int channels = field<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  const auto row_bytes = static_cast<std::size_t>(TIFFScanlineSize(tiff));
  if (row_bytes < sizeof(T) * static_cast<std::size_t>(width) * channels) refuse();
  std::vector<T> row(row_bytes / sizeof(T) + 1);
  cv::Mat pixels(height, width, type);
  for (int y = 0; y < height; ++y) {
    if (TIFFReadScanline(tiff, row.data(), static_cast<std::uint32_t>(y)) < 0) refuse();
    T* to = pixels.ptr<T>(y);
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) to[3 * x + c] = row[static_cast<std::size_t>(x) * channels + (channels >= 3 ? 2 - c : 0)];
  }
  return pixels;
}

cv::Mat byte_pixels(TIFF* tiff, int width, int height, int orientation) {
  std::vector<std::uint32_t> raster(static_cast<std::size_t>(width) * height);
  // The file's own orientation: libtiff turns nothing.
  if (!TIFFReadRGBAImageOriented(tiff, width, height, raster.data(), orientation, 1)) refuse();
  cv::Mat pixels(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint32_t rgba = raster[static_cast<std::size_t>(y) * width + x];
      std::uint8_t* bgr = pixels.ptr(y, x);
      bgr[0] = TIFFGetB(rgba), bgr[1] = TIFFGetG(rgba), bgr[2] = TIFFGetR(rgba);
    }
  return pixels;
}

}  // namespace

StoredPicture decode_tiff(std::span<const std::uint8_t> file) {
  [[maybe_unused]] static const auto quiet = std::pair(TIFFSetErrorHandler(nullptr), TIFFSetWarningHandler(nullptr));
  Input input{file};
  const TiffPtr tiff(
      TIFFClientOpen("picture", "rm", &input, read_bytes, write_nothing, seek, keep_open, size_of, nullptr, nullptr), TIFFClose);
  if (!tiff) refuse();
  const double width = field<std::uint32_t>(tiff.get(), TIFFTAG_IMAGEWIDTH, 0),
               height = field<std::uint32_t>(tiff.get(), TIFFTAG_IMAGELENGTH, 0);
  check_picture_size(width, height);
  const int columns = static_cast<int>(width), rows = static_cast<int>(height);
  const int orientation = field<std::uint16_t>(tiff.get(), TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  if (!is_deep(tiff.get())) return {byte_pixels(tiff.get(), columns, rows, orientation), orientation, {columns, rows}};
  const bool is_float = field<std::uint16_t>(tiff.get(), TIFFTAG_BITSPERSAMPLE, 8) == 32;
  return {is_float ? deep_pixels<float>(tiff.get(), columns, rows, CV_32FC3)
                   : deep_pixels<std::uint16_t>(tiff.get(), columns, rows, CV_16UC3),
          orientation,
          {columns, rows}};
}

}  // namespace catchlight::render
