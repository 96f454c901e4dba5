// Frame::codes(): every sample against FFmpeg's own reader, and parts of the picture against the whole.
#include "app/media/pixels/color_tags.hpp"
#include "catchlight/code_view.hpp"
#include "catchlight/color.hpp"
#include "tests/support/media_fixture.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace catchlight::app::testing {
namespace {

constexpr int kWidth = 63, kHeight = 37;  // the last chroma samples cover half as many pixels

Frame frame_of(FramePtr picture) {
  return {std::shared_ptr<const AVFrame>(std::move(picture)), 0, 0};
}

// All codes of one component.
struct Component {
  int across;
  std::vector<std::uint16_t> codes;
  double at(int x, int y) const { return codes[static_cast<std::size_t>(y * across + x)]; }
};

Component component_of(const AVFrame& picture, int index) {
  const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture.format));
  const bool is_chroma = index > 0 && (format->flags & AV_PIX_FMT_FLAG_RGB) == 0;
  const int across = is_chroma ? AV_CEIL_RSHIFT(picture.width, format->log2_chroma_w) : picture.width;
  const int down = is_chroma ? AV_CEIL_RSHIFT(picture.height, format->log2_chroma_h) : picture.height;
  Component component{across, std::vector<std::uint16_t>(static_cast<std::size_t>(across * down))};
  for (int y = 0; y < down; ++y)
    av_read_image_line(&component.codes[static_cast<std::size_t>(y * across)], const_cast<const std::uint8_t**>(picture.data),
                       picture.linesize, format, 0, y, index, across, 0);
  return component;
}

using Case = std::tuple<AVPixelFormat, AVColorRange>;

class CodesOf : public ::testing::TestWithParam<Case> {
 protected:
  static Frame frame() {
    const auto [format, range] = GetParam();
    FramePtr picture = noise_frame(format, kWidth, kHeight, 5);
    picture->color_range = range;
    picture->colorspace = AVCOL_SPC_BT709;
    return frame_of(std::move(picture));
  }
};

TEST_P(CodesOf, EveryPixelHasItsOwnLumaAndItsBlocksColor) {
  const Frame frame = CodesOf::frame();
  const CodeView codes = frame.codes();
  const PixelLayout layout = pixel_layout(frame.picture().format).value();
  const CodeFromRgb code_from_rgb(frame.picture(), layout);
  const bool is_gray = layout.model == ColorModel::gray;
  std::vector<Component> components;
  for (int i = 0; i < (is_gray ? 1 : 3); ++i) components.push_back(component_of(frame.picture(), i));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 back = code_from_rgb(codes.rgb(x, y));
      for (int i = 0; i < (is_gray ? 1 : 3); ++i) {
        const int sx = i > 0 ? layout.chroma_shift_x : 0, sy = i > 0 ? layout.chroma_shift_y : 0;
        ASSERT_NEAR(back[i], components[static_cast<std::size_t>(i)].at(x >> sx, y >> sy), 2e-6 * layout.max_code())
            << x << "," << y << " component " << i;
      }
    }
}

TEST_P(CodesOf, LumaAndColorAddUpToThePixels) {
  const Frame frame = CodesOf::frame();
  const CodeView codes = frame.codes();
  const std::vector<float> luma = luma_of(codes, {0, 0, kWidth, kHeight});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(luma[static_cast<std::size_t>(y * kWidth + x)] + codes.color(x, y)[c], codes.rgb(x, y)[c], 2e-6)
            << x << "," << y;
}

TEST_P(CodesOf, EveryPartEqualsThatPartOfTheWhole) {
  const Frame frame = CodesOf::frame();
  const CodeView codes = frame.codes();
  const std::vector<float> whole = luma_of(codes, {0, 0, kWidth, kHeight});
  for (const PixelRect& rect : {PixelRect{0, 0, 9, 9}, {1, 1, 20, 12}, {7, 5, 17, 9}, {kWidth - 5, kHeight - 3, 5, 3}}) {
    const std::vector<float> part = luma_of(codes, rect);
    for (int y = 0; y < rect.height; ++y)
      for (int x = 0; x < rect.width; ++x)
        ASSERT_EQ(part[static_cast<std::size_t>(y * rect.width + x)],
                  whole[static_cast<std::size_t>((rect.y + y) * kWidth + rect.x + x)])
            << x << "," << y;
  }
}

TEST_P(CodesOf, WholeBlocksLieInThePartAndAreAllThatDo) {
  const Frame frame = CodesOf::frame();
  const CodeView codes = frame.codes();
  const int across = 1 << codes.block_shift.x, down = 1 << codes.block_shift.y;
  for (const PixelRect& rect : {PixelRect{0, 0, 9, 9},
                                {1, 1, 20, 12},
                                {30, 20, 100, 100},
                                {-5, 3, 11, 6},
                                {3, 3, 0, 5},
                                {-9, -9, 9, 9},
                                {kWidth, 0, 4, 4}}) {
    const PixelRect blocks = codes.whole_blocks(rect), inside = intersect(rect, {0, 0, kWidth, kHeight});
    for (int y = 0; y < kHeight; y += down)
      for (int x = 0; x < kWidth; x += across) {
        const PixelRect block{x, y, across, down};
        EXPECT_EQ(intersect(blocks, block) == block, intersect(inside, block) == block) << x << "," << y;
      }
    EXPECT_EQ(blocks.width % across + blocks.height % down, 0);
  }
}

// swscale is another way to the same codes, but for the interpolation of chroma, which an even picture has none of. 8-bit grey it
// takes for full range, whatever the tags say.
TEST_P(CodesOf, AnEvenPictureHasTheCodesThatItIsConvertedTo) {
  const auto [format, range] = GetParam();
  if (format == AV_PIX_FMT_GRAY8 && range == AVCOL_RANGE_MPEG) return;
  FramePtr picture = noise_frame(format, 64, 32, 1);
  picture->color_range = range;
  picture->colorspace = AVCOL_SPC_BT709;
  const PixelLayout layout = pixel_layout(format).value();
  const glm::dvec3 samples = CodeFromRgb(*picture, layout)({0.7, 0.5, 0.4});
  for (int i = 0; i < (layout.model == ColorModel::gray ? 1 : 3); ++i) {
    const int sx = i > 0 ? layout.chroma_shift_x : 0, sy = i > 0 ? layout.chroma_shift_y : 0;
    for (int y = 0; y < 32 >> sy; ++y)
      for (int x = 0; x < 64 >> sx; ++x)
        SamplePlane(*picture, layout, i).set_code(x, y, static_cast<int>(std::lround(samples[i])));
  }
  const Frame frame = frame_of(std::move(picture));
  const Plate plate = frame.rgb({20, 10, 1, 1});
  const bool is_deep = plate.format == Plate::Format::rgb_u16;
  for (int c = 0; c < 3; ++c) {
    std::uint16_t wide = 0;
    std::memcpy(&wide, &plate.pixels[static_cast<std::size_t>(c) * (is_deep ? 2 : 1)], is_deep ? 2 : 1);
    EXPECT_NEAR(frame.codes().rgb(20, 10)[c], wide / (is_deep ? 65535.0 : 255.0), 1.01 / 255) << "channel " << c;
  }
}

std::string name_of(const ::testing::TestParamInfo<Case>& test) {
  return std::string(av_get_pix_fmt_name(std::get<0>(test.param))) +
         (std::get<1>(test.param) == AVCOL_RANGE_JPEG ? "_full" : "_limited");
}

INSTANTIATE_TEST_SUITE_P(Formats, CodesOf,
                         ::testing::Combine(::testing::Values(AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV422P, AV_PIX_FMT_YUV444P,
                                                              AV_PIX_FMT_YUV440P, AV_PIX_FMT_YUV411P, AV_PIX_FMT_YUV422P10LE,
                                                              AV_PIX_FMT_YUV420P10LE, AV_PIX_FMT_YUV444P16LE, AV_PIX_FMT_YUVA420P,
                                                              AV_PIX_FMT_NV12, AV_PIX_FMT_NV21, AV_PIX_FMT_P010LE,
                                                              AV_PIX_FMT_YUYV422, AV_PIX_FMT_UYVY422, AV_PIX_FMT_GRAY8,
                                                              AV_PIX_FMT_GRAY10LE, AV_PIX_FMT_GRAY16LE),
                                            ::testing::Values(AVCOL_RANGE_MPEG, AVCOL_RANGE_JPEG)),
                         name_of);

INSTANTIATE_TEST_SUITE_P(RgbFormats, CodesOf,
                         ::testing::Combine(::testing::Values(AV_PIX_FMT_RGB24, AV_PIX_FMT_BGR24, AV_PIX_FMT_RGBA,
                                                              AV_PIX_FMT_BGR0, AV_PIX_FMT_GBRP, AV_PIX_FMT_GBRP10LE,
                                                              AV_PIX_FMT_RGB48LE, AV_PIX_FMT_RGB48BE),
                                            ::testing::Values(AVCOL_RANGE_JPEG)),
                         name_of);

TEST(FrameCodes, FloatsAreAsTheyAre) {
  FramePtr picture = noise_frame(AV_PIX_FMT_GBRPF32LE, 8, 4, 1);
  const PixelLayout layout = pixel_layout(AV_PIX_FMT_GBRPF32LE).value();
  const glm::vec3 light(1234.5f, -0.25f, 65504.0f);
  for (int i = 0; i < 3; ++i) SamplePlane(*picture, layout, i).set_value(5, 2, light[i]);
  const Frame frame = frame_of(std::move(picture));
  EXPECT_TRUE(frame.codes().is_real);
  EXPECT_EQ(frame.codes().rgb(5, 2), light);
  EXPECT_EQ(frame.codes().rounding, glm::dmat3(0.0));
}

}  // namespace
}  // namespace catchlight::app::testing
