// Pictures of codes in files: PNG, JPEG and TIFF.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <vector>

namespace catchlight::render {

enum class PictureDepth {
  stored,     ///< 8 or 16 bits, or float (TIFF)
  eight_bits  ///< of 16 bits the upper 8
};

/// Reads a file that lies in memory: three channels, blue first, as OpenCV has them; gray is all three, transparency is left out;
/// turned upright where its EXIF or TIFF tags ask for that. Throws Error that says what is wrong, without a name: another format,
/// damaged or cut off, over 2^30 pixels.
cv::Mat decode_picture(std::span<const std::uint8_t> file, PictureDepth depth);

/// A picture with its opacity: four channels of 8 bits, blue first, opaque where the file says nothing of opacity.
struct ClearPicture {
  cv::Mat bgra;
  cv::Size file_size;  ///< pixels in the file
};

/// decode_picture with opacity, no side longer than `max_side`: of larger ones each pixel is the mean of several. PNG and JPEG
/// are made smaller while they are read.
ClearPicture decode_clear_picture(std::span<const std::uint8_t> file, int max_side);

/// decode_picture of a file on disk. Throws Error naming the file.
cv::Mat read_picture(const std::string& path, PictureDepth depth);

/// A PNG of 1, 3 (blue first) or 4 channels with 8 or 16 bits.
std::vector<std::uint8_t> encode_png(const cv::Mat& picture);

/// Writes encode_png to a new or empty file of that name. Throws Error naming the file.
void write_png(const std::string& path, const cv::Mat& picture);

}  // namespace catchlight::render
