// Frame::luma() and Frame::color().
#include <array>

#include "catchlight/luma_view.hpp"
#include "catchlight/response.hpp"
#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

Frame frame_of(FramePtr picture) {
  return {std::shared_ptr<const AVFrame>(std::move(picture)), 0, 0};
}

// A frame of one colour, by its codes.
FramePtr flat(AVPixelFormat format, const std::array<int, 3>& codes) {
  FramePtr frame = noise_frame(format, 4, 2, 1);
  const PixelLayout layout = pixel_layout(format).value();
  for (int i = 0; i < (layout.model == ColorModel::gray ? 1 : 3); ++i) {
    const bool chroma = layout.model == ColorModel::yuv && i > 0;
    for (int y = 0; y < (chroma ? 2 >> layout.chroma_shift_y : 2); ++y) {
      for (int x = 0; x < (chroma ? 4 >> layout.chroma_shift_x : 4); ++x) {
        SamplePlane(*frame, layout, i).set_code(x, y, codes[static_cast<std::size_t>(i)]);
      }
    }
  }
  return frame;
}

int luma_code(FramePtr picture) {
  const Frame frame = frame_of(std::move(picture));
  const LumaView luma = frame.luma();
  return luma.data[luma.stride + 3];  // the last pixel
}

TEST(FrameLuma, EightBitPlanesAreNotCopied) {
  for (const AVPixelFormat format :
       {AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV422P, AV_PIX_FMT_YUV444P, AV_PIX_FMT_NV12, AV_PIX_FMT_GRAY8}) {
    const Frame frame = frame_of(noise_frame(format, 64, 48, 1));
    EXPECT_EQ(frame.luma().data, frame.picture().data[0]);
    EXPECT_EQ(frame.luma().stride, frame.picture().linesize[0]);
  }
}

TEST(FrameLuma, PackedYuvIsMadeOnce) {
  const Frame frame = frame_of(flat(AV_PIX_FMT_YUYV422, {77, 100, 200}));
  const LumaView luma = frame.luma();
  EXPECT_EQ(luma.data[0], 77);
  EXPECT_EQ(luma.stride, 4);
  EXPECT_EQ(frame.luma().data, luma.data);
}

TEST(FrameLuma, BlackAndWhiteCodesFollowTheRange) {
  FramePtr limited = noise_frame(AV_PIX_FMT_YUV420P, 16, 16, 1), full = noise_frame(AV_PIX_FMT_YUV420P, 16, 16, 1);
  limited->color_range = AVCOL_RANGE_MPEG;
  full->color_range = AVCOL_RANGE_JPEG;
  const auto codes = [](FramePtr picture) {
    const LumaView luma = frame_of(std::move(picture)).luma();
    return std::pair(luma.black_code, luma.white_code);
  };
  EXPECT_EQ(codes(std::move(limited)), std::pair(16.0, 235.0));
  EXPECT_EQ(codes(std::move(full)), std::pair(0.0, 255.0));
  EXPECT_EQ(codes(noise_frame(AV_PIX_FMT_YUV420P, 16, 16, 1)), std::pair(16.0, 235.0));  // YUV without a word is limited,
  EXPECT_EQ(codes(noise_frame(AV_PIX_FMT_GRAY8, 16, 16, 1)), std::pair(0.0, 255.0));     // grey and
  EXPECT_EQ(codes(noise_frame(AV_PIX_FMT_RGB24, 16, 16, 1)), std::pair(0.0, 255.0));     // RGB are full
}

TEST(FrameLuma, DeepCodesAreRounded) {
  // Limited range: 10-bit codes are 8-bit ones times 4.
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_YUV420P10LE, {64, 512, 512})), 16);
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_YUV420P10LE, {940, 512, 512})), 235);
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_YUV420P10LE, {65, 512, 512})), 16);
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_YUV420P10LE, {66, 512, 512})), 17);
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_YUV420P10LE, {1023, 512, 512})), 255);
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_P010LE, {940, 512, 512})), 235);
  // Full range: the largest code is white at every depth.
  FramePtr full = flat(AV_PIX_FMT_YUV420P10LE, {1023, 512, 512});
  full->color_range = AVCOL_RANGE_JPEG;
  EXPECT_EQ(luma_code(std::move(full)), 255);
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_GRAY16LE, {65535, 0, 0})), 255);
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_GRAY16BE, {128 * 257, 0, 0})), 128);
}

TEST(FrameLuma, RgbIsWeightedByRec709) {
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_RGB24, {255, 0, 0})), 54);   // 54.2
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_BGR24, {0, 255, 0})), 182);  // 182.4
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_GBRP, {0, 0, 255})), 18);    // 18.4
  EXPECT_EQ(luma_code(flat(AV_PIX_FMT_RGB48BE, {65535, 65535, 65535})), 255);
}

TEST(FrameLuma, LinearFloatsAreCodedAsSrgb) {
  FramePtr picture = noise_frame(AV_PIX_FMT_GBRPF32LE, 4, 2, 1);
  picture->color_trc = AVCOL_TRC_LINEAR;
  const PixelLayout layout = pixel_layout(AV_PIX_FMT_GBRPF32LE).value();
  const float values[] = {0.318547f /* sRGB code 0.6 */, 7.0f, -1.0f, std::nanf("")};
  for (int i = 0; i < 3; ++i) {
    for (int x = 0; x < 4; ++x) SamplePlane(*picture, layout, i).set_value(x, 0, values[x]);
  }
  const Frame frame = frame_of(std::move(picture));
  EXPECT_EQ(frame.luma().transfer, TransferFunction::srgb);
  EXPECT_EQ(frame.color().transfer, TransferFunction::linear);
  const std::uint8_t* luma = frame.luma().data;
  EXPECT_EQ(luma[0], 153);
  EXPECT_EQ(luma[1], 255);
  EXPECT_EQ(luma[2], 0);
  EXPECT_EQ(luma[3], 0);
}

TEST(FrameColor, TransferFunctionsByTag) {
  const auto transfer = [](AVColorTransferCharacteristic tag) {
    FramePtr picture = noise_frame(AV_PIX_FMT_YUV420P, 16, 16, 1);
    picture->color_trc = tag;
    return frame_of(std::move(picture)).color().transfer;
  };
  for (const auto tag :
       {AVCOL_TRC_UNSPECIFIED, AVCOL_TRC_BT709, AVCOL_TRC_SMPTE170M, AVCOL_TRC_IEC61966_2_1, AVCOL_TRC_BT2020_10}) {
    EXPECT_EQ(transfer(tag), TransferFunction::srgb) << tag;
  }
  EXPECT_EQ(transfer(AVCOL_TRC_LINEAR), TransferFunction::linear);
  EXPECT_EQ(transfer(AVCOL_TRC_GAMMA22), TransferFunction::gamma22);
  EXPECT_EQ(transfer(AVCOL_TRC_GAMMA28), TransferFunction::gamma28);
  EXPECT_EQ(transfer(AVCOL_TRC_SMPTE2084), TransferFunction::pq);
  EXPECT_EQ(transfer(AVCOL_TRC_ARIB_STD_B67), TransferFunction::hlg);
}

glm::mat3 primaries(AVColorPrimaries tag) {
  FramePtr picture = noise_frame(AV_PIX_FMT_YUV420P, 16, 16, 1);
  picture->color_primaries = tag;
  return frame_of(std::move(picture)).color().plate_from_rec709;
}

TEST(FrameColor, Rec709IsExactlyTheIdentity) {
  EXPECT_EQ(primaries(AVCOL_PRI_BT709), glm::mat3(1.0f));
  EXPECT_EQ(primaries(AVCOL_PRI_UNSPECIFIED), glm::mat3(1.0f));
}

TEST(FrameColor, WhiteStaysWhite) {
  for (const auto tag : {AVCOL_PRI_BT2020, AVCOL_PRI_SMPTE432, AVCOL_PRI_SMPTE431, AVCOL_PRI_SMPTE170M, AVCOL_PRI_BT470BG}) {
    const glm::vec3 white = primaries(tag) * glm::vec3(1.0f);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(white[i], 1.0f, 1e-6f) << tag;  // float rounding
  }
}

// ITU-R BT.2087, equation for linear BT.709 to BT.2020, printed with four decimals.
TEST(FrameColor, Rec2020AsPublished) {
  const float published[3][3] = {{0.6274f, 0.3293f, 0.0433f}, {0.0691f, 0.9195f, 0.0114f}, {0.0164f, 0.0880f, 0.8956f}};
  const glm::mat3 ours = primaries(AVCOL_PRI_BT2020);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) EXPECT_NEAR(ours[column][row], published[row][column], 0.5e-4f + 1e-6f);
  }
}

TEST(FrameColor, AWiderGamutHoldsAllOfRec709) {
  for (const auto tag : {AVCOL_PRI_BT2020, AVCOL_PRI_SMPTE432}) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) EXPECT_GT(primaries(tag)[i][j], -1e-4f) << tag;  // P3's blue is Rec. 709's: zeros there
    }
  }
}

}  // namespace
}  // namespace catchlight::app::testing
