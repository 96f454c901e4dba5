#include "render/image/picture_file.hpp"
#include "catchlight/error.hpp"
#include "tests/support/test_files.hpp"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <vector>

// OpenCV's own codecs, which the product does not link, are the reference.
namespace catchlight::render {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::HasSubstr;

/// Something in every channel and not symmetric in anything, smooth enough for JPEG.
cv::Mat scene(int type, double full_scale) {
  cv::Mat picture(23, 37, type);
  const int channels = picture.channels();
  cv::Mat plain(23, 37 * channels, CV_64F);
  for (int y = 0; y < 23; ++y)
    for (int i = 0; i < 37 * channels; ++i)
      plain.at<double>(y, i) = full_scale * (0.1 + 0.02 * y + 0.01 * (i / channels) + 0.08 * (i % channels));
  cv::Mat(plain.reshape(channels)).convertTo(picture, picture.depth());
  return picture;
}

Bytes encoded(const std::string& extension, const cv::Mat& picture, const std::vector<int>& options = {}) {
  Bytes bytes;
  cv::imencode(extension, picture, bytes, options);
  return bytes;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

std::string decode_error(const Bytes& file) {
  return error_of([&] { decode_picture(file, PictureDepth::stored); });
}

struct Stored {
  const char* extension;
  int type;
  double full_scale;
};

Bytes encoded_scene(const Stored& stored) {
  constexpr int kNoCompression = 1;  // OpenCV's own choice for floats is a logarithmic kind, which nobody else writes
  return encoded(
      stored.extension, scene(stored.type, stored.full_scale),
      CV_MAT_DEPTH(stored.type) == CV_32F ? std::vector<int>{cv::IMWRITE_TIFF_COMPRESSION, kNoCompression} : std::vector<int>{});
}

void PrintTo(const Stored& stored, std::ostream* out) {
  *out << stored.extension << ' ' << cv::typeToString(stored.type);
}

class PictureFiles : public testing::TestWithParam<Stored> {};
INSTANTIATE_TEST_SUITE_P(, PictureFiles,
                         testing::Values(Stored{".png", CV_8UC1, 255}, Stored{".png", CV_8UC3, 255}, Stored{".png", CV_8UC4, 255},
                                         Stored{".png", CV_16UC1, 65535}, Stored{".png", CV_16UC3, 65535},
                                         Stored{".png", CV_16UC4, 65535}, Stored{".jpg", CV_8UC1, 255},
                                         Stored{".jpg", CV_8UC3, 255}, Stored{".tiff", CV_8UC1, 255},
                                         Stored{".tiff", CV_8UC3, 255}, Stored{".tiff", CV_16UC1, 65535},
                                         Stored{".tiff", CV_16UC3, 65535}, Stored{".tiff", CV_32FC3, 1}));

TEST_P(PictureFiles, AreReadAsOpenCvReadsThem) {
  const Bytes file = encoded_scene(GetParam());
  EXPECT_TRUE(same(decode_picture(file, PictureDepth::stored), cv::imdecode(file, cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH)));
  if (CV_MAT_DEPTH(GetParam().type) == CV_32F) return;
  const cv::Mat ours = decode_picture(file, PictureDepth::eight_bits), theirs = cv::imdecode(file, cv::IMREAD_COLOR);
  EXPECT_LE(cv::norm(ours, theirs, cv::NORM_INF),
            GetParam().extension == std::string(".tiff") ? 1 : 0);  // it rounds 16 bits of a TIFF
}

TEST_P(PictureFiles, AreRefusedWhereTheyEndEarly) {
  const Bytes whole = encoded_scene(GetParam());
  for (const double share : {0.05, 0.3, 0.6, 0.9}) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(whole.size())));
    EXPECT_NE(decode_error(part), "") << share;
  }
}

TEST_P(PictureFiles, DoNotCrashWhereTheyAreDamaged) {
  const Bytes whole = encoded_scene(GetParam());
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    Bytes changed = whole;
    for (int k = 0; k < 3; ++k) changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
    decode_error(changed);
  }
}

TEST(PictureFile, OfAnotherFormatIsRefused) {
  EXPECT_THAT(decode_error({}), HasSubstr("neither PNG nor JPEG nor TIFF"));
  EXPECT_THAT(decode_error(encoded(".bmp", scene(CV_8UC3, 255))), HasSubstr("neither PNG nor JPEG nor TIFF"));
}

TEST(PictureFile, OfFewBitsIsSpreadOut) {
  // Red, then a half transparent colour of a palette.
  const Bytes palette{0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
                      0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x03, 0x00, 0x00, 0x00, 0xc3, 0xfc, 0x8f, 0xb8, 0x00, 0x00, 0x00,
                      0x06, 0x50, 0x4c, 0x54, 0x45, 0xff, 0x00, 0x00, 0x0a, 0xc8, 0x1e, 0xb5, 0x18, 0xf7, 0xf0, 0x00, 0x00, 0x00,
                      0x02, 0x74, 0x52, 0x4e, 0x53, 0xff, 0x80, 0x08, 0x0f, 0xb3, 0x6a, 0x00, 0x00, 0x00, 0x0e, 0x49, 0x44, 0x41,
                      0x54, 0x78, 0x01, 0x01, 0x03, 0x00, 0xfc, 0xff, 0x00, 0x00, 0x01, 0x00, 0x04, 0x00, 0x02, 0x0b, 0x21, 0x8b,
                      0x71, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  EXPECT_TRUE(same(decode_picture(palette, PictureDepth::stored),
                   cv::Mat_<cv::Vec3b>{{1, 2}, {cv::Vec3b(0, 0, 255), cv::Vec3b(30, 200, 10)}}));
  // Nine greys of two bits.
  const Bytes greys{0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
                    0x00, 0x09, 0x00, 0x00, 0x00, 0x01, 0x02, 0x00, 0x00, 0x00, 0x00, 0x63, 0x19, 0xc3, 0x00, 0x00, 0x00, 0x00,
                    0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0x01, 0x01, 0x04, 0x00, 0xfb, 0xff, 0x00, 0x1b, 0xe4, 0x40, 0x02, 0x5d,
                    0x01, 0x40, 0x04, 0x12, 0x97, 0x7a, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const cv::Mat codes = cv::Mat_<std::uint8_t>({1, 9}, {0, 85, 170, 255, 255, 170, 85, 0, 85});
  cv::Mat expected;
  cv::merge(std::vector<cv::Mat>(3, codes), expected);
  EXPECT_TRUE(same(decode_picture(greys, PictureDepth::stored), expected));
}

/// The file with an EXIF segment that says how it is to be turned.
Bytes turned_jpeg(const Bytes& jpeg, int orientation) {
  const auto code = static_cast<std::uint8_t>(orientation);
  const Bytes segment{0xff, 0xe1, 0, 34,   'E', 'x', 'i', 'f', 0, 0, 'M', 'M',  0, 42, 0, 0, 0, 8,
                      0,    1,    1, 0x12, 0,   3,   0,   0,   0, 1, 0,   code, 0, 0,  0, 0, 0, 0};
  Bytes file(jpeg.begin(), jpeg.begin() + 2);
  file.insert(file.end(), segment.begin(), segment.end());
  file.insert(file.end(), jpeg.begin() + 2, jpeg.end());
  return file;
}

/// A TIFF without compression: 8-bit RGB in one strip.
Bytes turned_tiff(const cv::Mat& bgr, int orientation) {
  Bytes file{'I', 'I', 42, 0, 8, 0, 0, 0};
  const auto number = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) file.push_back(static_cast<std::uint8_t>(value >> 8 * i));
  };
  constexpr std::uint32_t kEntries = 9, kBits = 8 + 2 + 12 * kEntries + 4, kPixels = kBits + 6;
  const std::uint32_t columns = bgr.cols, rows = bgr.rows;
  const std::uint32_t entries[kEntries][4] = {{256, 4, 1, columns}, {257, 4, 1, rows},    {258, 3, 3, kBits},
                                              {262, 3, 1, 2},       {273, 4, 1, kPixels}, {274, 3, 1, std::uint32_t(orientation)},
                                              {277, 3, 1, 3},       {278, 4, 1, rows},    {279, 4, 1, 3 * columns * rows}};
  number(kEntries, 2);
  for (const auto& [tag, type, count, value] : entries) number(tag, 2), number(type, 2), number(count, 4), number(value, 4);
  number(0, 4);
  for (int c = 0; c < 3; ++c) number(8, 2);
  for (int y = 0; y < bgr.rows; ++y)
    for (int x = 0; x < bgr.cols; ++x)
      for (int c = 2; c >= 0; --c) file.push_back(bgr.ptr(y, x)[c]);
  return file;
}

TEST(PictureFile, IsTurnedUpright) {
  const cv::Mat picture = scene(CV_8UC3, 255);
  for (int orientation = 1; orientation <= 8; ++orientation) {
    for (const Bytes& file : {turned_jpeg(encoded(".jpg", picture), orientation), turned_tiff(picture, orientation)}) {
      const cv::Mat upright = decode_picture(file, PictureDepth::stored);
      EXPECT_EQ(upright.cols, orientation <= 4 ? picture.cols : picture.rows);
      EXPECT_TRUE(same(upright, cv::imdecode(file, cv::IMREAD_COLOR))) << orientation;
    }
  }
}

TEST(PictureFile, IsWrittenAsOpenCvWritesIt) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC3}) {
    const cv::Mat picture = scene(type, CV_MAT_DEPTH(type) == CV_8U ? 255 : 65535);
    EXPECT_EQ(encode_png(picture), encoded(".png", picture)) << type;
  }
  const cv::Mat part = scene(CV_8UC3, 255)(cv::Rect(3, 2, 11, 7));  // rows with gaps between them
  EXPECT_TRUE(same(cv::imdecode(encode_png(part), cv::IMREAD_COLOR), part));
}

TEST(PictureFile, IsNamedWhereItCannotBeRead) {
  const TempFolder folder;
  const auto file_error = [](const std::string& path) { return error_of([&] { read_picture(path, PictureDepth::stored); }); };
  EXPECT_THAT(file_error(folder / "missing.png"), HasSubstr("missing.png: cannot be opened"));
  EXPECT_THAT(file_error(folder / "."), HasSubstr("cannot be opened"));
  write_text(folder / "text.png", "no picture");
  EXPECT_THAT(file_error(folder / "text.png"), HasSubstr("text.png: is neither PNG"));
  write_png(folder / "a.png", scene(CV_8UC3, 255));
  EXPECT_TRUE(same(read_picture(folder / "a.png", PictureDepth::stored), scene(CV_8UC3, 255)));
  EXPECT_THAT(error_of([&] { write_png(folder / "none/a.png", scene(CV_8UC3, 255)); }), HasSubstr("none/a.png"));
}

}  // namespace
}  // namespace catchlight::render
