// The formats that picture_file.cpp chooses from. Private to render/image.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

namespace catchlight::render {

inline constexpr double kMaxPicturePixels = 1 << 30;

/// A picture as its file has it: three channels, blue first.
struct StoredPicture {
  cv::Mat pixels;
  int orientation = 1;  ///< EXIF's and TIFF's numbering
};

/// Throw Error where the file is damaged.
StoredPicture decode_png(std::span<const std::uint8_t> file);
StoredPicture decode_jpeg(std::span<const std::uint8_t> file);
StoredPicture decode_tiff(std::span<const std::uint8_t> file);

/// Throws Error where a picture is empty or larger than kMaxPicturePixels.
void check_picture_size(double width, double height);

}  // namespace catchlight::render
