#include <cstddef>
#include <cstdio>

#include <jpeglib.h>
// After jpeglib.h, which it needs.
#include <jerror.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <string>

#include "catchlight/error.hpp"
#include "render/image/exif.hpp"
#include "render/image/picture_formats.hpp"

namespace catchlight::render {
namespace {

// libjpeg leaves a function by longjmp where it fails. The functions that it may leave hold nothing that a destructor would free.
struct Failure {
  jpeg_error_mgr manager{};  // first: libjpeg hands out its address
  std::jmp_buf where{};
  char message[JMSG_LENGTH_MAX]{};
};

void leave(j_common_ptr jpeg) {
  auto* failure = reinterpret_cast<Failure*>(jpeg->err);
  jpeg->err->format_message(jpeg, failure->message);
  std::longjmp(failure->where, 1);
}

// A file that is cut off is only a warning to libjpeg, which makes the rest grey.
void leave_where_cut_off(j_common_ptr jpeg, int level) {
  if (level < 0 && (jpeg->err->msg_code == JWRN_JPEG_EOF || jpeg->err->msg_code == JWRN_HIT_MARKER)) leave(jpeg);
}

struct Reader {
  Failure failure;
  jpeg_decompress_struct jpeg{};
  Reader() {
    jpeg.err = jpeg_std_error(&failure.manager);
    failure.manager.error_exit = leave;
    failure.manager.emit_message = leave_where_cut_off;
  }
  Reader(const Reader&) = delete;
  ~Reader() { jpeg_destroy_decompress(&jpeg); }
};

// Blue first; ink colours of print (CMYK, YCCK) as four channels.
bool start(Reader* reader, std::span<const std::uint8_t> file, int max_side) {
  if (setjmp(reader->failure.where)) return false;
  jpeg_create_decompress(&reader->jpeg);
  jpeg_mem_src(&reader->jpeg, file.data(), static_cast<unsigned long>(file.size()));
  jpeg_read_header(&reader->jpeg, TRUE);
  reader->jpeg.out_color_space = reader->jpeg.num_components == 4 ? JCS_CMYK : JCS_EXT_BGR;
  // The format itself gives means over 2, 4 and 8 pixels.
  const JDIMENSION side = std::max(reader->jpeg.image_width, reader->jpeg.image_height);
  while (reader->jpeg.scale_denom < 8 && side / reader->jpeg.scale_denom > static_cast<JDIMENSION>(max_side))
    reader->jpeg.scale_denom *= 2;
  jpeg_start_decompress(&reader->jpeg);
  return true;
}

bool read_rows(Reader* reader, std::uint8_t* first_row, std::size_t bytes_per_row) {
  if (setjmp(reader->failure.where)) return false;
  while (reader->jpeg.output_scanline < reader->jpeg.output_height) {
    JSAMPROW row = first_row + reader->jpeg.output_scanline * bytes_per_row;
    jpeg_read_scanlines(&reader->jpeg, &row, 1);
  }
  jpeg_finish_decompress(&reader->jpeg);
  return true;
}

// Adobe's files hold inks inverted: what is left of the light.
cv::Mat bgr_of_inks(const cv::Mat& cmyk) {
  cv::Mat bgr(cmyk.size(), CV_8UC3);
  for (int y = 0; y < cmyk.rows; ++y)
    for (int x = 0; x < cmyk.cols; ++x) {
      const std::uint8_t* ink = cmyk.ptr(y, x);
      for (int c = 0; c < 3; ++c) bgr.ptr(y, x)[c] = static_cast<std::uint8_t>(ink[3] - ((255 - ink[2 - c]) * ink[3] >> 8));
    }
  return bgr;
}

[[noreturn]] void refuse(const Reader& reader) {
  throw Error("is a damaged JPEG (" + std::string(reader.failure.message) + ")");
}

}  // namespace

StoredPicture decode_jpeg(std::span<const std::uint8_t> file, const PictureWish& wish) {
  Reader reader;
  if (!start(&reader, file, wish.max_side)) refuse(reader);
  check_picture_size(reader.jpeg.output_width, reader.jpeg.output_height);
  cv::Mat pixels(static_cast<int>(reader.jpeg.output_height), static_cast<int>(reader.jpeg.output_width),
                 CV_8UC(reader.jpeg.output_components));
  if (!read_rows(&reader, pixels.data, pixels.step)) refuse(reader);
  return {pixels.channels() == 4 ? bgr_of_inks(pixels) : pixels,
          exif_tags(file).orientation.value_or(1),
          {static_cast<int>(reader.jpeg.image_width), static_cast<int>(reader.jpeg.image_height)}};
}

}  // namespace catchlight::render
