// Numbered image files, in and out.
#include "app/media/read/sequence.hpp"
#include "catchlight/error.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "tests/support/media_fixture.hpp"

#include <gmock/gmock.h>

namespace catchlight::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(SequencePattern, NamesAndNumbersAreInverse) {
  const auto pattern = SequencePattern::parse("shots/a.%04d.png").value();
  EXPECT_EQ(pattern.folder(), "shots");
  for (const std::int64_t number : {0, 7, 1001, 9999, 10000, 123456}) {
    EXPECT_EQ(pattern.number_of(pattern.file(number).filename().string()), number);
  }
  EXPECT_EQ(pattern.file(7), "shots/a.0007.png");
  EXPECT_EQ(pattern.file(10000), "shots/a.10000.png");
}

TEST(SequencePattern, OtherNamesHaveNoNumber) {
  const auto padded = SequencePattern::parse("a.%04d.png").value();
  for (const char* name :
       {"a.7.png", "a.00007.png", "a.0007.jpg", "b.0007.png", "a..png", "a.-001.png", "a.00x7.png", "a.0007.png.png"}) {
    EXPECT_EQ(padded.number_of(name), std::nullopt) << name;
  }
  EXPECT_EQ(SequencePattern::parse("%d.png").value().number_of("007.png"), std::nullopt);
  EXPECT_EQ(SequencePattern::parse("%d.png").value().number_of("0.png"), 0);
}

TEST(SequencePattern, OnlyOneNumberField) {
  for (const char* path : {"video.mp4", "50%.png", "%s.png", "%4d.png", "%04d_%04d.png", "%00d.png", "%d/frame.png"}) {
    EXPECT_FALSE(SequencePattern::parse(path)) << path;
  }
}

TEST(SequencePattern, HashesAreNukesDigits) {
  const auto pattern = SequencePattern::parse("shots/a.####.png").value();
  EXPECT_EQ(pattern.file(7), "shots/a.0007.png");
  EXPECT_EQ(pattern.number_of("a.1001.png"), 1001);
  EXPECT_EQ(pattern.printf_path(), "shots/a.%04d.png");
  EXPECT_EQ(SequencePattern::parse("b/take#2.##.png").value().file(3), "b/take#2.03.png");
  for (const char* path : {"take#2.mp4", "a.##.##.png", "###/a.png"}) EXPECT_FALSE(SequencePattern::parse(path)) << path;
}

class Sequence : public MediaTest {
 protected:
  void make(const std::string& pattern, int first, int count, const std::string& options = "") {
    ffmpeg("-f lavfi -i testsrc2=size=64x48:rate=24 -frames:v " + std::to_string(count) + " " + options + " -start_number " +
           std::to_string(first) + " '" + path(pattern) + "'");
  }
};

TEST_F(Sequence, KeepsTheNumbersOfItsFiles) {
  make("f.%04d.png", 1001, 3);
  const auto source = MediaSource::open(path("f.%04d.png"));
  EXPECT_TRUE(source->info().is_sequence);
  EXPECT_EQ(source->info().first_number, 1001);
  EXPECT_EQ(source->info().frame_count, 3);
  EXPECT_EQ(source->info().frame_rate, 24);
  EXPECT_EQ(source->info().width_px, 64);
  EXPECT_EQ(source->video_stream(), nullptr);
  const auto frames = read_all(*source);
  ASSERT_EQ(frames.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(frames[static_cast<std::size_t>(i)].number(), 1001 + i);
    EXPECT_NEAR(frames[static_cast<std::size_t>(i)].time_s(), i / 24.0, 1e-12);
  }
}

TEST_F(Sequence, TheRateIsWhatTheCallerSays) {
  make("f.%04d.png", 0, 3);
  const auto source = MediaSource::open(path("f.%04d.png"), 30000.0 / 1001);
  EXPECT_NEAR(source->info().frame_rate, 30000.0 / 1001, 1e-6);
  EXPECT_NEAR(read_all(*source).back().time_s(), 2 * 1001 / 30000.0, 1e-6);
  EXPECT_THROW(MediaSource::open(path("f.%04d.png"), 0), UsageError);
}

TEST_F(Sequence, HashesReadAndWriteTheSameFiles) {
  make("f.%04d.png", 1001, 2);
  EXPECT_EQ(read_all(path("f.####.png")).size(), 2u);
  pass_through(path("f.####.png"), path("o.####.png"));
  EXPECT_THAT(files(), ElementsAre("f.1001.png", "f.1002.png", "o.1001.png", "o.1002.png"));
}

TEST_F(Sequence, ExrFilesSayTheirRateUnlessTheCallerDoes) {
  make("f.%02d.exr", 1, 3, "-vf format=gbrpf32le -r 30000/1001");
  EXPECT_NEAR(MediaSource::open(path("f.%02d.exr"))->info().frame_rate, 30000.0 / 1001, 1e-9);
  EXPECT_NEAR(read_all(path("f.%02d.exr")).back().time_s(), 2 * 1001 / 30000.0, 1e-9);
  EXPECT_EQ(MediaSource::open(path("f.%02d.exr"), 25)->info().frame_rate, 25);
}

TEST_F(Sequence, ARateForAVideoIsRefused) {
  make("video.mp4", 0, 3);
  EXPECT_THAT(message_of<UsageError>([&] { MediaSource::open(path("video.mp4"), 25); }),
              HasSubstr("--fps is for image sequences"));
}

TEST_F(Sequence, AGapIsNamed) {
  make("f.%04d.png", 1001, 5);
  std::filesystem::remove(path("f.1003.png"));
  const std::string message = message_of<Error>([&] { MediaSource::open(path("f.%04d.png")); });
  EXPECT_THAT(message, HasSubstr("1003"));
  EXPECT_THAT(message, HasSubstr("f.1003.png"));
}

TEST_F(Sequence, NoFileAtAll) {
  EXPECT_THAT(message_of<Error>([&] { MediaSource::open(path("f.%04d.png")); }), HasSubstr("no file matches"));
  EXPECT_THAT(message_of<Error>([&] { MediaSource::open(path("nowhere/f.%04d.png")); }), HasSubstr("no file matches"));
}

TEST_F(Sequence, AnUnreadableFileEndsItWithTheCountOfTheRest) {
  make("f.%04d.png", 1, 4);
  write_bytes(path("f.0003.png"), {});
  const auto source = MediaSource::open(path("f.%04d.png"));
  EXPECT_TRUE(source->read());
  EXPECT_TRUE(source->read());
  EXPECT_THAT(message_of<DamagedMedia>([&] { source->read(); }), HasSubstr("2 of 4 frames"));
  EXPECT_FALSE(source->read());
}

TEST_F(Sequence, ATruncatedFileEndsItToo) {
  make("f.%04d.png", 1, 4);
  auto bytes = bytes_of(path("f.0003.png"));
  bytes.resize(bytes.size() / 2);
  write_bytes(path("f.0003.png"), bytes);
  const auto source = MediaSource::open(path("f.%04d.png"));
  EXPECT_TRUE(source->read());
  EXPECT_TRUE(source->read());
  EXPECT_THROW(source->read(), DamagedMedia);
}

TEST_F(Sequence, PicturesOfAnotherSizeEndIt) {
  make("f.%04d.png", 1, 2);
  ffmpeg("-f lavfi -i testsrc2=size=32x48 -frames:v 1 '" + path("f.0003.png") + "'");
  const auto source = MediaSource::open(path("f.%04d.png"));
  EXPECT_TRUE(source->read());
  EXPECT_TRUE(source->read());
  EXPECT_THAT(message_of<DamagedMedia>([&] { source->read(); }), HasSubstr("another size"));
}

TEST_F(Sequence, ExrIsLinearFloat) {
  make("f.%03d.exr", 5, 2, "-pix_fmt gbrpf32le -vf format=gbrpf32le");
  const auto frames = read_all(path("f.%03d.exr"));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].number(), 5);
  EXPECT_EQ(frames[0].color().transfer, TransferFunction::linear);
  EXPECT_EQ(frames[0].rgb({0, 0, 2, 2}).format, Plate::Format::rgb_f32);
}

TEST_F(Sequence, JpegIsFullRangeYuv) {
  make("f.%03d.jpg", 0, 2, "-pix_fmt yuvj420p -q:v 2");
  const Frame frame = read_all(path("f.%03d.jpg")).at(0);
  EXPECT_EQ(frame.picture().format, AV_PIX_FMT_YUV420P);
  EXPECT_EQ(frame.luma().white_code, 255);
}

TEST_F(Sequence, PalettesAndBitPackedPicturesBecomePlain) {
  make("p.%03d.png", 0, 1, "-pix_fmt pal8");
  make("m.%03d.png", 0, 1, "-pix_fmt monob");
  EXPECT_EQ(read_all(path("m.%03d.png")).at(0).picture().format, AV_PIX_FMT_GRAY8);
  const Frame frame = read_all(path("p.%03d.png")).at(0);
  ffmpeg("-i '" + path("p.000.png") + "' -f rawvideo -pix_fmt rgb24 '" + path("whole.rgb") + "'");
  const Plate plate = frame.rgb({0, 0, 64, 48});
  const auto expected = bytes_of(path("whole.rgb"));
  ASSERT_EQ(plate.pixels.size(), expected.size());
  EXPECT_EQ(std::memcmp(plate.pixels.data(), expected.data(), expected.size()), 0);
}

TEST_F(Sequence, PngOutIsNumberedLikeTheFrames) {
  make("f.%04d.png", 1001, 3, "-pix_fmt rgb24");
  pass_through(path("f.%04d.png"), path("out.%04d.png"), {}, 1002);
  EXPECT_THAT(files(), ElementsAre("f.1001.png", "f.1002.png", "f.1003.png", "out.1002.png", "out.1003.png"));
  const auto in = read_all(path("f.%04d.png")), out = read_all(path("out.%04d.png"));
  EXPECT_EQ(samples_of(in[1].picture()), samples_of(out[0].picture()));
}

// Also the proof that a pass-through to pictures is the conversion everybody knows.
TEST_F(Sequence, PngFromVideoEqualsFfmpegs) {
  ffmpeg("-f lavfi -i testsrc2=size=130x98:rate=10 -frames:v 3 -pix_fmt yuv420p -colorspace bt709 -c:v libx264 -qp 12 '" +
         path("in.mp4") + "'");
  ffmpeg("-i '" + path("in.mp4") + "' -sws_flags accurate_rnd+full_chroma_int -start_number 0 '" + path("theirs.%02d.png") + "'");
  pass_through(path("in.mp4"), path("ours.%02d.png"));
  const auto ours = read_all(path("ours.%02d.png")), theirs = read_all(path("theirs.%02d.png"));
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_EQ(samples_of(ours[i].picture()), samples_of(theirs[i].picture()));
}

TEST_F(Sequence, DeepPicturesStayDeep) {
  make("f.%04d.png", 0, 1, "-pix_fmt rgb48be");
  pass_through(path("f.%04d.png"), path("o.%04d.png"));
  EXPECT_EQ(samples_of(read_all(path("f.%04d.png"))[0].picture()), samples_of(read_all(path("o.%04d.png"))[0].picture()));
  EXPECT_EQ(ffprobe(path("o.0000.png"), "-show_entries stream=pix_fmt"), "rgb48be\n");
}

TEST_F(Sequence, SequenceToVideoAndBackIsLossless) {
  make("f.%04d.png", 0, 3, "-pix_fmt rgb24");
  SinkOptions lossless;
  lossless.codec = "ffv1";
  pass_through(path("f.%04d.png"), path("v.mkv"), lossless);
  pass_through(path("v.mkv"), path("o.%04d.png"));
  const auto in = read_all(path("f.%04d.png")), out = read_all(path("o.%04d.png"));
  ASSERT_EQ(out.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(samples_of(in[i].picture()), samples_of(out[i].picture()));
}

TEST_F(Sequence, NothingIsLeftOfAnUnfinishedOne) {
  make("f.%04d.png", 0, 2);
  {
    const auto source = MediaSource::open(path("f.%04d.png"));
    const auto sink = MediaSink::open(path("o.%04d.png"), path("f.%04d.png"), *source, {});
    sink->write(*source->read());
  }
  EXPECT_THAT(files(), ElementsAre("f.0000.png", "f.0001.png"));
}

TEST_F(Sequence, AnExistingFileIsKeptUnlessAskedFor) {
  make("f.%04d.png", 0, 2);
  write_bytes(path("o.0001.png"), {1, 2, 3});
  EXPECT_THAT(message_of<UsageError>([&] { pass_through(path("f.%04d.png"), path("o.%04d.png")); }), HasSubstr("o.0001.png"));
  EXPECT_EQ(bytes_of(path("o.0001.png")).size(), 3u);
  SinkOptions overwrite;
  overwrite.overwrite = true;
  pass_through(path("f.%04d.png"), path("o.%04d.png"), overwrite);
  EXPECT_GT(bytes_of(path("o.0001.png")).size(), 3u);
}

TEST_F(Sequence, TheInputIsNeverOverwritten) {
  make("f.%04d.png", 0, 2);
  SinkOptions overwrite;
  overwrite.overwrite = true;
  EXPECT_THAT(message_of<UsageError>([&] { pass_through(path("f.%04d.png"), path("./f.%04d.png"), overwrite); }),
              HasSubstr("input itself"));
}

}  // namespace
}  // namespace catchlight::app::testing
