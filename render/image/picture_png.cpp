#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "catchlight/error.hpp"
#include "render/image/exif.hpp"
#include "render/image/picture_file.hpp"
#include "render/image/picture_formats.hpp"

namespace catchlight::render {
namespace {

// libpng leaves a function by longjmp where it fails. The functions that it may leave hold nothing that a destructor would free.

struct Input {
  std::span<const std::uint8_t> left;
};

void read_bytes(png_structp png, png_bytep to, std::size_t size) {
  auto& input = *static_cast<Input*>(png_get_io_ptr(png));
  if (size > input.left.size()) png_error(png, "the file ends early");
  std::memcpy(to, input.left.data(), size);
  input.left = input.left.subspan(size);
}

void append_bytes(png_structp png, png_bytep bytes, std::size_t size) {
  auto& output = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  output.insert(output.end(), bytes, bytes + size);
}

using Message = char[128];

void keep_message(png_structp png, png_const_charp text) {
  std::strncpy(*static_cast<Message*>(png_get_error_ptr(png)), text, sizeof(Message) - 1);
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

// Three channels of 8 or 16 bits, blue first, whatever the file has; opacity behind them where it is wanted and there.
bool read_header(png_structp png, png_infop info, bool with_opacity) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_info(png, info);
  const png_byte color = png_get_color_type(png, info), depth = png_get_bit_depth(png, info);
  if (depth == 16) png_set_swap(png);  // the file has the high byte first
  if (!with_opacity) png_set_strip_alpha(png);
  if (with_opacity && png_get_valid(png, info, PNG_INFO_tRNS)) png_set_tRNS_to_alpha(png);
  if (color == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (color == PNG_COLOR_TYPE_GRAY && depth < 8) png_set_expand_gray_1_2_4_to_8(png);
  if (color & PNG_COLOR_MASK_COLOR)
    png_set_bgr(png);
  else
    png_set_gray_to_rgb(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

bool read_row(png_structp png, png_bytep row) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_row(png, row, nullptr);
  return true;
}

// Fast rather than small: what is written is looked at, or compressed again.
bool write_all(png_structp png, png_infop info, png_bytepp rows, int width, int height, int channels, int depth) {
  if (setjmp(png_jmpbuf(png))) return false;
  const int color = channels == 1 ? PNG_COLOR_TYPE_GRAY : channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA;
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  constexpr int kFastest = 1, kRunLengths = 3;  // zlib's Z_BEST_SPEED and Z_RLE
  png_set_compression_level(png, kFastest);
  png_set_compression_strategy(png, kRunLengths);
  png_set_IHDR(png, info, width, height, depth, color, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_bgr(png);
  if (depth == 16) png_set_swap(png);
  png_write_image(png, rows);
  png_write_end(png, info);
  return true;
}

struct Reader {
  Message message{};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, keep_message, ignore_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Reader() = default;
  Reader(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
  Message message{};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, keep_message, ignore_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Writer() = default;
  Writer(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

std::vector<png_bytep> rows_of(const cv::Mat& picture) {
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(picture.rows));
  for (int y = 0; y < picture.rows; ++y) rows.push_back(const_cast<png_bytep>(picture.ptr(y)));
  return rows;
}

[[noreturn]] void refuse(const Message& message) {
  throw Error("is a damaged PNG (" + std::string(message[0] ? message : "no memory") + ")");
}

// Means over squares of `side` pixels, so that never more than `side` rows of the file are in memory.
cv::Mat read_reduced(const Reader& reader, cv::Size size, int type, int side) {
  cv::Mat reduced(std::max(size.height / side, 1), std::max(size.width / side, 1), type),
      rows(std::min(side, size.height), size.width, type);
  for (int y = 0; y < reduced.rows; ++y) {
    for (int i = 0; i < rows.rows; ++i)
      if (!read_row(reader.png, rows.ptr(i))) refuse(reader.message);
    cv::resize(rows, reduced.row(y), cv::Size(reduced.cols, 1), 0, 0, cv::INTER_AREA);
  }
  return reduced;
}

}  // namespace

StoredPicture decode_png(std::span<const std::uint8_t> file, const PictureWish& wish) {
  Reader reader;
  if (!reader.info) refuse(reader.message);
  Input input{file};
  png_set_read_fn(reader.png, &input, read_bytes);
  if (!read_header(reader.png, reader.info, wish.with_opacity)) refuse(reader.message);
  const double width = png_get_image_width(reader.png, reader.info), height = png_get_image_height(reader.png, reader.info);
  check_picture_size(width, height);
  const cv::Size size(static_cast<int>(width), static_cast<int>(height));
  const int depth = png_get_bit_depth(reader.png, reader.info) == 16 ? CV_16U : CV_8U;
  const int type = CV_MAKETYPE(depth, png_get_channels(reader.png, reader.info));
  const int orientation = exif_tags(file).orientation.value_or(1);
  const int side = 1 + (std::max(size.width, size.height) - 1) / wish.max_side;
  if (side > 1 && png_get_interlace_type(reader.png, reader.info) == PNG_INTERLACE_NONE)
    return {read_reduced(reader, size, type, side), orientation, size};
  StoredPicture picture{cv::Mat(size, type), orientation, size};
  std::vector<png_bytep> rows = rows_of(picture.pixels);
  if (!read_rows(reader.png, rows.data())) refuse(reader.message);
  return picture;
}

std::vector<std::uint8_t> encode_png(const cv::Mat& picture) {
  Writer writer;
  std::vector<std::uint8_t> file;
  std::vector<png_bytep> rows = rows_of(picture);
  if (writer.info) png_set_write_fn(writer.png, &file, append_bytes, nullptr);
  if (!writer.info || !write_all(writer.png, writer.info, rows.data(), picture.cols, picture.rows, picture.channels(),
                                 picture.depth() == CV_16U ? 16 : 8))
    throw Error("a PNG cannot be made: " + std::string(writer.message));
  return file;
}

}  // namespace catchlight::render
