// Frame::rgb() against the ffmpeg command, which converts whole frames in a process of its own.
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

struct Case {
  std::string pixel_format, matrix, range;
  int width, height;
  std::string name() const {
    return pixel_format + "_" + matrix + "_" + range + "_" + std::to_string(width) + "x" + std::to_string(height);
  }
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name();
}

class RgbAgainstFfmpeg : public MediaTest, public ::testing::WithParamInterface<Case> {
 protected:
  // One noisy frame in FFV1 (lossless), and the same converted by the command.
  void make_files() {
    const Case& c = GetParam();
    const std::string size = std::to_string(c.width) + "x" + std::to_string(c.height);
    const std::string tags = c.matrix == "unknown" ? "" : "-colorspace " + c.matrix;
    ffmpeg("-f lavfi -i testsrc=size=" + size + ":rate=1 -frames:v 1 -vf 'format=" + c.pixel_format +
           ",noise=alls=60:all_seed=7' -pix_fmt " + c.pixel_format + " " + tags + " -color_range " + c.range + " -c:v ffv1 '" +
           path("in.mkv") + "'");
    ffmpeg("-i '" + path("in.mkv") + "' -sws_flags accurate_rnd+full_chroma_int -f rawvideo -pix_fmt " +
           (is_deep() ? "rgb48le" : "rgb24") + " '" + path("whole.rgb") + "'");
  }
  // swscale's one flaw that is put right: see RgbOfGreys below.
  void stretch(std::vector<std::uint8_t>& rgb48) const {
    const double white = GetParam().range == "pc" ? 1023 * 64 : 255 * 256;
    for (std::size_t i = 0; i < rgb48.size(); i += 2) {
      const int code = static_cast<int>(std::min((rgb48[i] | rgb48[i + 1] << 8) * (65535 / white) + 0.5, 65535.0));
      rgb48[i] = static_cast<std::uint8_t>(code);
      rgb48[i + 1] = static_cast<std::uint8_t>(code >> 8);
    }
  }
  bool is_deep() const { return GetParam().pixel_format.find("p1") != std::string::npos; }
};

// The rows of `rect` out of a whole packed picture.
std::vector<std::uint8_t> part_of(const std::vector<std::uint8_t>& whole, int width, int pixel_bytes, const PixelRect& rect) {
  std::vector<std::uint8_t> part;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    const auto row = whole.begin() + (static_cast<std::ptrdiff_t>(y) * width + rect.x) * pixel_bytes;
    part.insert(part.end(), row, row + static_cast<std::ptrdiff_t>(rect.width) * pixel_bytes);
  }
  return part;
}

TEST_P(RgbAgainstFfmpeg, EveryPartEqualsThatPartOfTheWholeFrame) {
  make_files();
  const auto [pixel_format, matrix, range, width, height] = GetParam();
  const std::vector<std::uint8_t> whole = bytes_of(path("whole.rgb"));
  const Frame frame = read_all(path("in.mkv")).at(0);
  const int pixel_bytes = is_deep() ? 6 : 3;
  const PixelRect parts[] = {{0, 0, width, height},  // all
                             {0, 0, 1, 1},           // a corner
                             {width - 1, height - 1, 1, 1},
                             {37, 41, 50, 33},          // odd everywhere
                             {64, 64, 64, 64},          // on the grid that parts are padded to
                             {width - 31, 3, 31, 90}};  // along the right edge
  for (const PixelRect& rect : parts) {
    const Plate plate = frame.rgb(rect);
    EXPECT_EQ(plate.rect, rect);
    EXPECT_EQ(plate.format, is_deep() ? Plate::Format::rgb_u16 : Plate::Format::rgb_u8);
    std::vector<std::uint8_t> expected = part_of(whole, width, pixel_bytes, rect);
    if (is_deep()) stretch(expected);
    ASSERT_EQ(plate.pixels.size(), expected.size());
    EXPECT_EQ(std::memcmp(plate.pixels.data(), expected.data(), expected.size()), 0)
        << rect.x << "," << rect.y << " " << rect.width << "x" << rect.height;
  }
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* format : {"yuv420p", "yuv422p", "yuv444p", "yuv420p10le", "yuv422p10le"}) {
    for (const char* matrix : {"bt709", "smpte170m"}) {
      for (const char* range : {"tv", "pc"}) cases.push_back({format, matrix, range, 322, 242});
    }
  }
  cases.push_back({"yuv420p", "bt2020nc", "tv", 322, 242});
  cases.push_back({"yuv420p", "unknown", "tv", 322, 242});
  cases.push_back({"yuv420p", "unknown", "tv", 1280, 720});  // no guess by size
  cases.push_back({"yuv420p", "bt709", "tv", 323, 243});     // the last chroma samples cover half as many pixels
  cases.push_back({"gray", "unknown", "tv", 322, 242});
  cases.push_back({"gray", "unknown", "pc", 322, 242});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Formats, RgbAgainstFfmpeg, ::testing::ValuesIn(all_cases()),
                         [](const auto& test) { return test.param.name(); });

class RgbOfGreys : public ::testing::TestWithParam<std::tuple<AVPixelFormat, AVColorRange>> {};

// Closed form: black is 0, white is full scale, and what lies between is in proportion. (swscale alone gives 65283 for white.)
TEST_P(RgbOfGreys, RunFromZeroToFullScale) {
  const auto [format, range] = GetParam();
  const PixelLayout layout = pixel_layout(format).value();
  const double step = 1 << (layout.depth() - 8), full = (1 << layout.depth()) - 1;
  const double black = range == AVCOL_RANGE_MPEG ? 16 * step : 0, white = range == AVCOL_RANGE_MPEG ? 235 * step : full;
  for (int eighths = 0; eighths <= 8; ++eighths) {
    FramePtr picture = noise_frame(format, 64, 32, 1);
    picture->color_range = range;
    const int luma = static_cast<int>(std::lround(black + (white - black) * eighths / 8));
    for (int i = 0; i < (layout.model == ColorModel::gray ? 1 : 3); ++i) {
      const int shift_x = i > 0 ? layout.chroma_shift_x : 0, shift_y = i > 0 ? layout.chroma_shift_y : 0;
      for (int y = 0; y < 32 >> shift_y; ++y) {
        for (int x = 0; x < 64 >> shift_x; ++x)
          SamplePlane(*picture, layout, i).set_code(x, y, i > 0 ? static_cast<int>(128 * step) : luma);
      }
    }
    const Frame frame(std::shared_ptr<const AVFrame>(std::move(picture)), 0, 0);
    const Plate plate = frame.rgb({20, 10, 1, 1});
    std::uint16_t codes[3] = {};
    std::memcpy(codes, plate.pixels.data(), plate.pixels.size());
    const double expected = (luma - black) / (white - black) * 65535;
    // swscale's fixed-point coefficients have 13 bits.
    for (const std::uint16_t code : codes) EXPECT_NEAR(code, expected, 65535.0 / (1 << 13)) << luma;
  }
}

INSTANTIATE_TEST_SUITE_P(DeepFormats, RgbOfGreys,
                         ::testing::Combine(::testing::Values(AV_PIX_FMT_YUV420P10LE, AV_PIX_FMT_YUV422P12LE,
                                                              AV_PIX_FMT_YUV444P16LE, AV_PIX_FMT_P010LE, AV_PIX_FMT_GRAY10LE,
                                                              AV_PIX_FMT_GRAY16LE),
                                            ::testing::Values(AVCOL_RANGE_MPEG, AVCOL_RANGE_JPEG)));

TEST(FrameRgb, PartsBeyondTheFrameAreCutOff) {
  const Frame frame(std::shared_ptr<const AVFrame>(noise_frame(AV_PIX_FMT_YUV420P, 32, 16, 1)), 0, 0);
  EXPECT_EQ(frame.rgb({-5, -5, 10, 100}).rect, (PixelRect{0, 0, 5, 16}));
  EXPECT_TRUE(frame.rgb({40, 0, 4, 4}).pixels.empty());
}

TEST(FrameRgb, FloatsAreHandedOutAsTheyAre) {
  FramePtr picture = noise_frame(AV_PIX_FMT_GBRPF32LE, 8, 4, 1);
  const PixelLayout layout = pixel_layout(AV_PIX_FMT_GBRPF32LE).value();
  SamplePlane(*picture, layout, 0).set_value(5, 2, 1234.5f);  // above white
  SamplePlane(*picture, layout, 1).set_value(5, 2, -0.25f);   // below black
  SamplePlane(*picture, layout, 2).set_value(5, 2, 65504.0f);
  const Frame frame(std::shared_ptr<const AVFrame>(std::move(picture)), 0, 0);
  const Plate plate = frame.rgb({5, 2, 1, 1});
  EXPECT_EQ(plate.format, Plate::Format::rgb_f32);
  float rgb[3];
  ASSERT_EQ(plate.pixels.size(), sizeof rgb);
  std::memcpy(rgb, plate.pixels.data(), sizeof rgb);
  EXPECT_EQ(rgb[0], 1234.5f);
  EXPECT_EQ(rgb[1], -0.25f);
  EXPECT_EQ(rgb[2], 65504.0f);
}

}  // namespace
}  // namespace catchlight::app::testing
