// The formats that picture_file.cpp chooses from. Private to render/image.
#pragma once

#include <cstdint>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <span>

namespace catchlight::render {

inline constexpr double kMaxPicturePixels = 1 << 30;

/// What of a picture is wanted.
struct PictureWish {
  bool with_opacity = false;
  int max_side = std::numeric_limits<int>::max();  ///< larger ones are made smaller while they are read, where the format allows
};

/// A picture as its file has it: three channels, blue first; opacity is the fourth where it is wanted and there.
struct StoredPicture {
  cv::Mat pixels;
  int orientation = 1;  ///< EXIF's and TIFF's numbering
  cv::Size file_size;   ///< pixels in the file
};

/// Throw Error where the file is damaged.
StoredPicture decode_png(std::span<const std::uint8_t> file, const PictureWish& wish);
StoredPicture decode_jpeg(std::span<const std::uint8_t> file, const PictureWish& wish);
StoredPicture decode_tiff(std::span<const std::uint8_t> file);

/// Throws Error where a picture is empty or larger than kMaxPicturePixels.
void check_picture_size(double width, double height);

}  // namespace catchlight::render
