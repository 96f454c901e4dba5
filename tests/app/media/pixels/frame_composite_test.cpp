// Frame::with_composite(): what is touched, what is not, and which codes are written.
#include <random>

#include "app/media/pixels/full_color.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "tests/support/media_fixture.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace catchlight::app::testing {
namespace {

constexpr int kWidth = 62, kHeight = 38;

Frame frame_of(FramePtr picture) {
  return {std::shared_ptr<const AVFrame>(std::move(picture)), 7, 0.25};
}

// A composite over `rect` with roughly `share` of its pixels changed, to random colours.
Composite random_composite(const PixelRect& rect, double share, unsigned seed) {
  std::mt19937 random(seed);
  Composite composite;
  composite.rect = rect;
  for (int i = 0; i < rect.width * rect.height; ++i) {
    const bool changed = (random() % 1000) / 1000.0 < share;
    for (int c = 0; c < 3; ++c) composite.rgba.push_back(static_cast<float>(random() % 1001) / 1000.0f);
    composite.rgba.push_back(changed ? 1.0f : 0.0f);
  }
  return composite;
}

bool is_changed(const Composite& composite, int x, int y) {
  const PixelRect& r = composite.rect;
  if (x < r.x || y < r.y || x >= r.x + r.width || y >= r.y + r.height) return false;
  return composite.rgba[static_cast<std::size_t>(4 * ((y - r.y) * r.width + x - r.x) + 3)] == 1.0f;
}

class EveryFormat : public ::testing::TestWithParam<AVPixelFormat> {};

// The check is FFmpeg's own reader of single components, which shares nothing with the writer.
std::vector<std::uint16_t> component_line(const AVFrame& picture, int component, int y, int samples) {
  const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture.format));
  std::vector<std::uint16_t> line(static_cast<std::size_t>(samples));
  av_read_image_line(line.data(), const_cast<const std::uint8_t**>(picture.data), picture.linesize, format, 0, y, component,
                     samples, 0);
  return line;
}

TEST_P(EveryFormat, SamplesOfUnchangedPixelsAreTheDecodersOwn) {
  const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(GetParam());
  FramePtr picture = noise_frame(GetParam(), kWidth, kHeight, 3);
  const Frame before = frame_of(std::move(picture));
  const Composite composite = random_composite({5, 7, 33, 21}, 0.2, 11);
  const Frame after = before.with_composite(composite);
  ASSERT_EQ(after.picture().format, GetParam());
  EXPECT_EQ(after.number(), 7);
  EXPECT_EQ(after.time_s(), 0.25);

  int touched = 0;
  for (int c = 0; c < format->nb_components; ++c) {
    const bool chroma = (format->flags & AV_PIX_FMT_FLAG_RGB) == 0 && (c == 1 || c == 2) && format->nb_components > 2;
    const bool alpha = (format->flags & AV_PIX_FMT_FLAG_ALPHA) != 0 && c == format->nb_components - 1;
    const int shift_x = chroma ? format->log2_chroma_w : 0, shift_y = chroma ? format->log2_chroma_h : 0;
    for (int y = 0; y < -(-kHeight >> shift_y); ++y) {
      const int samples = -(-kWidth >> shift_x);
      const auto was = component_line(before.picture(), c, y, samples), is = component_line(after.picture(), c, y, samples);
      for (int x = 0; x < samples; ++x) {
        bool may_change = false;
        for (int dy = 0; dy < 1 << shift_y; ++dy) {
          for (int dx = 0; dx < 1 << shift_x; ++dx) may_change |= is_changed(composite, (x << shift_x) + dx, (y << shift_y) + dy);
        }
        const auto i = static_cast<std::size_t>(x);
        if (!may_change || alpha) {
          ASSERT_EQ(was[i], is[i]) << "component " << c << " at " << x << "," << y;
        }
        touched += was[i] != is[i];
      }
    }
  }
  EXPECT_GT(touched, 100);  // about 139 pixels changed, in at least one component each
}

/// The rectangle says where to look, not what to write: however it lies to the blocks of pixels that share a chroma sample.
TEST_P(EveryFormat, ALargerRectangleOfTheSamePixelsWritesTheSame) {
  const Frame before = frame_of(noise_frame(GetParam(), kWidth, kHeight, 3));
  const Composite small = random_composite({5, 7, 33, 21}, 0.7, 11);
  Composite large;
  large.rect = {0, 0, kWidth, kHeight};
  large.rgba.resize(4 * kWidth * kHeight, 0.0f);
  for (int y = 0; y < small.rect.height; ++y)
    std::copy_n(small.rgba.begin() + 4 * y * small.rect.width, 4 * small.rect.width,
                large.rgba.begin() + 4 * ((small.rect.y + y) * kWidth + small.rect.x));
  EXPECT_EQ(samples_of(before.with_composite(small).picture()), samples_of(before.with_composite(large).picture()));
}

/// A plate that comes with the composite saves reading it again, be it all that is wanted or a part.
TEST_P(EveryFormat, ThePlateMayComeWithTheComposite) {
  const Frame before = frame_of(noise_frame(GetParam(), kWidth, kHeight, 3));
  Composite composite = random_composite({5, 7, 33, 21}, 0.7, 11);
  const auto expected = samples_of(before.with_composite(composite).picture());
  for (const PixelRect& held : {composite.rect, PixelRect{0, 0, kWidth, kHeight}, PixelRect{5, 7, 33, 20}}) {
    composite.plate = std::make_shared<const Plate>(before.rgb(held));
    EXPECT_EQ(samples_of(before.with_composite(composite).picture()), expected);
  }
}

/// Bands, last one first, each with no codes where nothing changed.
TEST_P(EveryFormat, BandsMakeTheWhole) {
  const Frame before = frame_of(noise_frame(GetParam(), kWidth, kHeight, 3));
  const Composite whole = random_composite({5, 7, 33, 21}, 0.7, 11);
  FrameWriter writer(before);
  for (int top = kHeight / kCompositeBandRows * kCompositeBandRows; top >= 0; top -= kCompositeBandRows) {
    Composite band;
    band.rect = intersect({whole.rect.x, top, whole.rect.width, kCompositeBandRows}, whole.rect);
    if (band.rect.empty()) continue;
    const auto row_floats = static_cast<std::ptrdiff_t>(4) * whole.rect.width;
    const auto first = whole.rgba.begin() + (band.rect.y - whole.rect.y) * row_floats;
    band.rgba.assign(first, first + band.rect.height * row_floats);
    for (std::size_t i = 0; i < band.rgba.size(); ++i)
      if (band.rgba[i / 4 * 4 + 3] == 0) band.rgba[i] = 0;
    writer.write(band);
  }
  const Frame after = std::move(writer).finish();
  EXPECT_EQ(samples_of(after.picture()), samples_of(before.with_composite(whole).picture()));
  EXPECT_EQ(after.number(), before.number());
}

TEST_P(EveryFormat, TheDecodersFrameItselfStaysAsItWas) {
  const Frame before = frame_of(noise_frame(GetParam(), kWidth, kHeight, 3));
  const auto samples = samples_of(before.picture());
  const Frame after = before.with_composite(random_composite({0, 0, kWidth, kHeight}, 1.0, 5));
  EXPECT_EQ(samples_of(before.picture()), samples);
  EXPECT_NE(samples_of(after.picture()), samples);
}

// The written codes, read back through swscale as display RGB, are what was asked for.
TEST_P(EveryFormat, AFlatColourComesBack) {
  const PixelLayout layout = pixel_layout(GetParam()).value();
  if (layout.model == ColorModel::gray) return;
  Composite composite = random_composite({0, 0, kWidth, kHeight}, 1.0, 5);
  const float rgb[3] = {0.8f, 0.35f, 0.1f};
  for (std::size_t i = 0; i < composite.rgba.size(); ++i) {
    if (i % 4 < 3) composite.rgba[i] = rgb[i % 4];
  }
  const Plate plate = frame_of(noise_frame(GetParam(), kWidth, kHeight, 3)).with_composite(composite).rgb({20, 10, 1, 1});
  const double white = layout.depth() > 8 ? 65535 : 255;
  // RGB is exact to half a code. YUV's three roundings add up to 1.3 codes of 8 bits (blue moves 2.02 per code of Cb in limited
  // range), swscale's own adds 1.
  const double tolerance =
      (layout.model == ColorModel::rgb ? 0.51 : 2.5) / (layout.depth() == 16 ? 65535 : (1 << layout.depth()) - 1);
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint16_t code = 0;
    std::memcpy(&code, plate.pixels.data() + i * (white > 255 ? 2 : 1), white > 255 ? 2 : 1);
    EXPECT_NEAR(code / white, rgb[i], tolerance) << "component " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         ::testing::Values(AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV422P, AV_PIX_FMT_YUV444P, AV_PIX_FMT_YUV440P,
                                           AV_PIX_FMT_YUV411P, AV_PIX_FMT_YUV422P10LE, AV_PIX_FMT_YUV420P10LE,
                                           AV_PIX_FMT_YUVA420P, AV_PIX_FMT_NV12, AV_PIX_FMT_NV21, AV_PIX_FMT_P010LE,
                                           AV_PIX_FMT_YUYV422, AV_PIX_FMT_UYVY422, AV_PIX_FMT_RGB24, AV_PIX_FMT_BGR24,
                                           AV_PIX_FMT_RGBA, AV_PIX_FMT_BGR0, AV_PIX_FMT_GBRP, AV_PIX_FMT_GBRP10LE,
                                           AV_PIX_FMT_RGB48LE, AV_PIX_FMT_RGB48BE, AV_PIX_FMT_GRAY8, AV_PIX_FMT_GRAY10LE,
                                           AV_PIX_FMT_GRAY16LE),
                         [](const auto& test) { return std::string(av_get_pix_fmt_name(test.param)); });

// Known codes: ITU-R BT.709 and BT.601, 8 bits, limited and full range; Poynton's tables of colour bars.
struct KnownCode {
  AVColorSpace matrix;
  AVColorRange range;
  glm::vec3 rgb;
  int y, cb, cr;
};

TEST(WithComposite, ColourBarsHaveTheCodesOfTheStandards) {
  const KnownCode bars[] = {{AVCOL_SPC_BT709, AVCOL_RANGE_MPEG, {1, 1, 1}, 235, 128, 128},
                            {AVCOL_SPC_BT709, AVCOL_RANGE_MPEG, {0, 0, 0}, 16, 128, 128},
                            {AVCOL_SPC_BT709, AVCOL_RANGE_MPEG, {1, 0, 0}, 63, 102, 240},
                            {AVCOL_SPC_BT709, AVCOL_RANGE_MPEG, {0, 1, 0}, 173, 42, 26},
                            {AVCOL_SPC_BT709, AVCOL_RANGE_MPEG, {0, 0, 1}, 32, 240, 118},
                            {AVCOL_SPC_SMPTE170M, AVCOL_RANGE_MPEG, {1, 0, 0}, 81, 90, 240},
                            {AVCOL_SPC_SMPTE170M, AVCOL_RANGE_MPEG, {0, 1, 0}, 145, 54, 34},
                            {AVCOL_SPC_SMPTE170M, AVCOL_RANGE_MPEG, {0, 0, 1}, 41, 240, 110},
                            {AVCOL_SPC_UNSPECIFIED, AVCOL_RANGE_MPEG, {1, 0, 0}, 81, 90, 240},
                            {AVCOL_SPC_BT470BG, AVCOL_RANGE_JPEG, {1, 0, 0}, 76, 85, 255},
                            {AVCOL_SPC_BT470BG, AVCOL_RANGE_JPEG, {1, 1, 1}, 255, 128, 128}};
  for (const KnownCode& bar : bars) {
    FramePtr picture = noise_frame(AV_PIX_FMT_YUV420P, 8, 8, 1);
    picture->colorspace = bar.matrix;
    picture->color_range = bar.range;
    Composite composite;
    composite.rect = {0, 0, 8, 8};
    for (int i = 0; i < 4 * 64; ++i) composite.rgba.push_back(i % 4 == 3 ? 1.0f : bar.rgb[i % 4]);
    const Frame after = frame_of(std::move(picture)).with_composite(composite);
    EXPECT_EQ(after.picture().data[0][0], bar.y);
    EXPECT_EQ(after.picture().data[1][0], bar.cb);
    EXPECT_EQ(after.picture().data[2][0], bar.cr);
  }
}

// 4:2:0, grey plate (chroma 128), red where changed. BT.601: red's Cb is 90.2, Cr 240, so a whole block moves by -37.8 and +112.
TEST(WithComposite, ASharedChromaSampleMovesByItsShareOfTheChange) {
  for (int changed = 0; changed <= 4; ++changed) {
    FramePtr picture = noise_frame(AV_PIX_FMT_YUV420P, 16, 16, 1);
    for (int y = 0; y < 16; ++y) std::memset(picture->data[0] + y * picture->linesize[0], 126, 16);
    for (int p = 1; p < 3; ++p) {
      for (int y = 0; y < 8; ++y) std::memset(picture->data[p] + y * picture->linesize[p], 128, 8);
    }
    Composite composite;
    composite.rect = {4, 4, 2, 2};
    for (int i = 0; i < 4; ++i) {
      for (const float value : {1.0f, 0.0f, 0.0f, i < changed ? 1.0f : 0.0f}) composite.rgba.push_back(value);
    }
    const Frame after = frame_of(std::move(picture)).with_composite(composite);
    EXPECT_EQ(after.picture().data[1][2 * after.picture().linesize[1] + 2], std::lround(128 - 37.797 * changed / 4)) << changed;
    EXPECT_EQ(after.picture().data[2][2 * after.picture().linesize[2] + 2], 128 + 28 * changed) << changed;
  }
}

// A pixel "changed" to the very colour it had leaves the chroma that it shares with unchanged pixels alone, whatever
// interpolation made of it.
TEST(WithComposite, PaintingThePlateOnAPartOfABlockDoesNotMoveItsChroma) {
  const Frame before = frame_of(noise_frame(AV_PIX_FMT_YUV420P, kWidth, kHeight, 9));
  const PixelRect all{0, 0, kWidth, kHeight};
  const Plate plate = before.rgb(all);
  Composite composite;
  composite.rect = all;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        composite.rgba.push_back(
            static_cast<float>(std::to_integer<int>(plate.pixels[static_cast<std::size_t>(3 * (y * kWidth + x) + c)])) / 255.0f);
      }
      composite.rgba.push_back((x + y) % 2 == 0 ? 1.0f : 0.0f);  // two pixels of each block
    }
  }
  const Frame after = before.with_composite(composite);
  for (int p = 1; p < 3; ++p) {
    for (int y = 0; y < kHeight / 2; ++y) {
      const int row = y * before.picture().linesize[p];
      ASSERT_EQ(std::memcmp(before.picture().data[p] + row, after.picture().data[p] + row, kWidth / 2), 0);
    }
  }
}

// Upright stripes of red and blue, a pixel wide: 4:2:0 has one colour for both, full colour each its own. 16-bit footage alike.
TEST(WithComposite, AnObjectHasTheFootagesResolutionOfColourUnlessItIsMadeFullColour) {
  Composite composite;
  composite.rect = {4, 4, 16, 16};
  for (int i = 0; i < 16 * 16; ++i)
    for (const float value : {i % 2 ? 0.75f : 0.25f, 0.5f, i % 2 ? 0.25f : 0.75f, 1.0f}) composite.rgba.push_back(value);
  for (const AVPixelFormat format : {AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV420P10LE}) {
    const Frame footage = frame_of(noise_frame(format, kWidth, kHeight, 9));
    const auto stripes = [&](const Frame& frame) {  // how much redder the second of two neighbours is, of 1
      const Plate plate = frame.with_composite(composite).rgb({10, 10, 2, 1});
      const auto red_less_blue = [&](std::size_t pixel) {
        const auto code = [&](std::size_t c) {
          if (plate.format == Plate::Format::rgb_u8) return std::to_integer<int>(plate.pixels[3 * pixel + c]) / 255.0;
          return (std::to_integer<int>(plate.pixels[6 * pixel + 2 * c]) +
                  256 * std::to_integer<int>(plate.pixels[6 * pixel + 2 * c + 1])) /
                 65535.0;
        };
        return code(0) - code(2);
      };
      return red_less_blue(1) - red_less_blue(0);
    };
    EXPECT_NEAR(stripes(footage), 0, 0.02) << format;
    EXPECT_NEAR(stripes(with_full_color(footage)), 1, 0.02) << format;
  }
}

TEST(WithComposite, NothingVirtualInSightSharesTheDecodersSamples) {
  const Frame before = frame_of(noise_frame(AV_PIX_FMT_YUV420P, kWidth, kHeight, 9));
  EXPECT_EQ(&before.with_composite({}).picture(), &before.picture());
}

TEST(WithComposite, ReachingOutOfTheFrameIsCutOff) {
  const Frame before = frame_of(noise_frame(AV_PIX_FMT_YUV420P, kWidth, kHeight, 9));
  const Frame after = before.with_composite(random_composite({-10, kHeight - 5, kWidth + 20, 30}, 1.0, 3));
  EXPECT_EQ(std::memcmp(before.picture().data[0], after.picture().data[0], kWidth), 0);
  EXPECT_NE(std::memcmp(before.picture().data[0] + (kHeight - 1) * before.picture().linesize[0],
                        after.picture().data[0] + (kHeight - 1) * after.picture().linesize[0], kWidth),
            0);
}

TEST(WithComposite, CodesBeyondTheRangeAndNotANumberAreClamped) {
  Composite composite;
  composite.rect = {0, 0, 3, 1};
  composite.rgba = {2.0f, 2.0f, 2.0f, 1.0f, -1.0f, -1.0f, -1.0f, 1.0f, NAN, NAN, NAN, 1.0f};
  const Frame after = frame_of(noise_frame(AV_PIX_FMT_RGB24, 8, 8, 1)).with_composite(composite);
  EXPECT_EQ(after.picture().data[0][0], 255);
  EXPECT_EQ(after.picture().data[0][3], 0);
  EXPECT_EQ(after.picture().data[0][6], 0);
}

TEST(WithComposite, FloatFramesTakeValuesAsTheyAre) {
  const Frame before = frame_of(noise_frame(AV_PIX_FMT_GBRPF32LE, 8, 8, 1));
  Composite composite;
  composite.rect = {2, 3, 1, 1};
  composite.rgba = {17.5f, -0.5f, 0.125f, 1.0f};
  const Frame after = before.with_composite(composite);
  const PixelLayout layout = pixel_layout(AV_PIX_FMT_GBRPF32LE).value();
  EXPECT_EQ(SamplePlane(after.picture(), layout, 0).value(2, 3), 17.5f);
  EXPECT_EQ(SamplePlane(after.picture(), layout, 1).value(2, 3), -0.5f);
  EXPECT_EQ(SamplePlane(after.picture(), layout, 2).value(2, 3), 0.125f);
  EXPECT_EQ(SamplePlane(after.picture(), layout, 0).value(3, 3), SamplePlane(before.picture(), layout, 0).value(3, 3));
}

}  // namespace
}  // namespace catchlight::app::testing
