// Videos in: what is delivered, in which orientation, and what is said of those that cannot be read.
#include <gmock/gmock.h>

#include "catchlight/error.hpp"
#include "tests/support/media_fixture.hpp"

extern "C" {
#include <libavutil/display.h>
}

namespace catchlight::app::testing {
namespace {

using ::testing::HasSubstr;

class VideoIn : public MediaTest {
 protected:
  // 20 frames, 2 s, of a moving picture with noise, so that a frame's data has some length.
  void make(const std::string& name, const std::string& options) {
    ffmpeg("-f lavfi -i testsrc2=size=160x120:rate=10:duration=2 -vf noise=alls=20:all_seed=3 " + options + " '" + path(name) +
           "'");
  }
  void cut(const std::string& from, const std::string& to, double share) {
    auto bytes = bytes_of(path(from));
    bytes.resize(static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
    write_bytes(path(to), bytes);
  }
};

TEST_F(VideoIn, DeliversEveryFrameInOrder) {
  make("v.mp4", "-c:v libx264 -bf 3 -pix_fmt yuv420p");
  const auto source = MediaSource::open(path("v.mp4"));
  EXPECT_EQ(source->info().frame_count, 20);
  EXPECT_EQ(source->info().frame_rate, 10);
  EXPECT_EQ(source->info().codec, "h264");
  EXPECT_EQ(source->info().pixel_format, "yuv420p");
  EXPECT_FALSE(source->info().is_sequence);
  EXPECT_NE(source->video_stream(), nullptr);
  const auto frames = read_all(*source);
  ASSERT_EQ(frames.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(frames[i].number(), static_cast<std::int64_t>(i));
    EXPECT_NEAR(frames[i].time_s(), static_cast<double>(i) / 10, 1e-9);
  }
  EXPECT_FALSE(source->read());
}

TEST_F(VideoIn, SamplesAreTheDecodersOwn) {
  for (const char* format : {"yuv420p", "yuv422p10le", "yuv444p"}) {
    SCOPED_TRACE(format);
    make("v.mkv", std::string("-c:v libx264 -pix_fmt ") + format);
    ffmpeg("-i '" + path("v.mkv") + "' -f rawvideo '" + path("v.raw") + "'");
    std::vector<std::uint8_t> all;
    for (const Frame& frame : read_all(path("v.mkv"))) {
      const auto samples = samples_of(frame.picture());
      all.insert(all.end(), samples.begin(), samples.end());
    }
    EXPECT_EQ(all, bytes_of(path("v.raw")));
  }
}

// All eight orientations that a display matrix can ask for, against the command's autorotation.
class Rotated : public VideoIn, public ::testing::WithParamInterface<int> {};

TEST_P(Rotated, LooksAsFfmpegShowsIt) {
  make("plain.mp4", "-c:v libx264 -pix_fmt yuv420p -frames:v 3");
  // The matrix sits in the track header: 9 big-endian numbers, a b u c d v x y w, the identity in a file without rotation.
  constexpr int kMatrices[8][4] = {{1, 0, 0, 1},  {0, 1, -1, 0}, {-1, 0, 0, -1}, {0, -1, 1, 0},
                                   {-1, 0, 0, 1}, {1, 0, 0, -1}, {0, 1, 1, 0},   {0, -1, -1, 0}};
  const auto put = [](std::vector<std::uint8_t>& to, int unit) {
    const auto value = static_cast<std::uint32_t>(unit * 65536);
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<std::uint8_t>(value >> shift));
  };
  const auto matrix = [&](const int* m) {
    std::vector<std::uint8_t> bytes;
    for (const int unit : {m[0], m[1], 0, m[2], m[3], 0, 0, 0}) put(bytes, unit);
    return bytes;
  };
  auto file = bytes_of(path("plain.mp4"));
  const std::string_view tag = "tkhd";
  const auto header = std::search(file.begin(), file.end(), tag.begin(), tag.end());
  ASSERT_NE(header, file.end());
  const auto identity = matrix(kMatrices[0]), wanted = matrix(kMatrices[GetParam()]);
  const auto place = std::search(header, file.end(), identity.begin(), identity.end());
  ASSERT_NE(place, file.end());
  std::copy(wanted.begin(), wanted.end(), place);
  write_bytes(path("turned.mp4"), file);

  ffmpeg("-i '" + path("turned.mp4") + "' -f rawvideo '" + path("theirs.raw") + "'");
  const auto source = MediaSource::open(path("turned.mp4"));
  const bool on_its_side = kMatrices[GetParam()][0] == 0;
  EXPECT_EQ(source->info().width_px, on_its_side ? 120 : 160);
  EXPECT_EQ(source->info().height_px, on_its_side ? 160 : 120);
  std::vector<std::uint8_t> ours;
  while (const auto frame = source->read()) {
    EXPECT_GT(frame->luma().stride, 0);
    const auto samples = samples_of(frame->picture());
    ours.insert(ours.end(), samples.begin(), samples.end());
  }
  EXPECT_EQ(ours, bytes_of(path("theirs.raw")));

  // Written out, the picture is upright and no longer asks for a rotation.
  SinkOptions lossless;
  lossless.codec = "ffv1";
  pass_through(path("turned.mp4"), path("upright.mkv"), lossless);
  ffmpeg("-i '" + path("upright.mkv") + "' -f rawvideo '" + path("again.raw") + "'");
  EXPECT_EQ(ours, bytes_of(path("again.raw")));
}

INSTANTIATE_TEST_SUITE_P(Orientations, Rotated, ::testing::Range(0, 8));

TEST_F(VideoIn, TheNameMayHoldAColonAndSpaces) {
  make("a b:c.mkv", "-c:v ffv1 -frames:v 1");
  EXPECT_EQ(read_all(path("a b:c.mkv")).size(), 1u);
}

TEST_F(VideoIn, VideoIsFoundBesideCoverArtAndSound) {
  ffmpeg("-f lavfi -i testsrc2=size=64x48:duration=1:rate=5 -f lavfi -i sine=duration=1 '" + path("v.mkv") + "'");
  EXPECT_EQ(read_all(path("v.mkv")).size(), 5u);
  ffmpeg("-f lavfi -i testsrc2=size=64x48 -frames:v 1 '" + path("cover.png") + "'");
  ffmpeg("-f lavfi -i sine=duration=1 -i '" + path("cover.png") + "' -map 0 -map 1 -c:v copy -disposition:v attached_pic '" +
         path("song.mp3") + "'");
  EXPECT_THAT(message_of<Error>([&] { MediaSource::open(path("song.mp3")); }), HasSubstr("no video stream"));
}

TEST_F(VideoIn, NoSuchFile) {
  EXPECT_THAT(message_of<Error>([&] { MediaSource::open(path("none.mp4")); }), HasSubstr("no such file: '" + path("none.mp4")));
}

TEST_F(VideoIn, AFolder) {
  EXPECT_THAT(message_of<Error>([&] { MediaSource::open(path("")); }), HasSubstr("%04d.png"));
}

TEST_F(VideoIn, NotAVideo) {
  write_bytes(path("text.txt"), std::vector<std::uint8_t>(5000, 'a'));
  EXPECT_THROW(MediaSource::open(path("text.txt")), Error);
  write_bytes(path("text.mp4"), std::vector<std::uint8_t>(5000, 'a'));
  EXPECT_THAT(message_of<Error>([&] { MediaSource::open(path("text.mp4")); }), HasSubstr("text.mp4"));
  write_bytes(path("empty.mp4"), {});
  EXPECT_THROW(MediaSource::open(path("empty.mp4")), Error);
}

TEST_F(VideoIn, ATruncatedMp4WithItsIndexAtTheEndCannotBeOpened) {
  make("whole.mp4", "-c:v libx264 -pix_fmt yuv420p");
  cut("whole.mp4", "cut.mp4", 0.6);
  EXPECT_THAT(message_of<Error>([&] { MediaSource::open(path("cut.mp4")); }), HasSubstr("cut short"));
}

class Truncated : public VideoIn, public ::testing::WithParamInterface<std::tuple<std::string, double>> {};

TEST_P(Truncated, DeliversTheFramesBeforeTheDamageAndThenSaysSo) {
  const auto [name, share] = GetParam();
  make(name, "-c:v libx264 -g 5 -bf 2 -pix_fmt yuv420p -movflags +faststart");
  const auto whole = read_all(path(name));
  cut(name, "cut_" + name, share);
  std::vector<Frame> before;
  const std::string message = message_of<DamagedMedia>([&] {
    const auto source = MediaSource::open(path("cut_" + name));
    while (auto frame = source->read()) before.push_back(*frame);
  });
  EXPECT_THAT(message, HasSubstr("cut_" + name));
  EXPECT_THAT(message, HasSubstr(std::to_string(before.size())));
  EXPECT_GE(before.size(), static_cast<std::size_t>(share * 20) - 5);  // the data of a reordered group may be missing its end
  EXPECT_LT(before.size(), 20u);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(samples_of(before[i].picture()), samples_of(whole[i].picture())) << i;
}

INSTANTIATE_TEST_SUITE_P(Containers, Truncated,
                         ::testing::Combine(::testing::Values("v.mp4", "v.mkv", "v.mov"), ::testing::Values(0.5, 0.8)));

// Without B frames: those are shown before, but decoded after, what they refer to.
TEST_F(VideoIn, FlippedBitsInsideAFrameAreFound) {
  make("v.mkv", "-c:v libx264 -bf 0 -pix_fmt yuv420p");
  const auto whole = read_all(path("v.mkv"));
  auto bytes = bytes_of(path("v.mkv"));
  for (std::size_t i = 0; i < 600; ++i) bytes[bytes.size() / 2 + i] ^= 0x55;
  write_bytes(path("bad.mkv"), bytes);
  const auto source = MediaSource::open(path("bad.mkv"));
  std::size_t before = 0;
  EXPECT_THAT(message_of<DamagedMedia>([&] {
                for (; const auto frame = source->read(); ++before) {
                  EXPECT_EQ(samples_of(frame->picture()), samples_of(whole.at(before).picture()));
                }
              }),
              HasSubstr("bad.mkv"));
  EXPECT_GT(before, 2u);
  EXPECT_FALSE(source->read());
}

TEST_F(VideoIn, AnEditListThatHidesFramesIsNoDamage) {
  make("v.mp4", "-c:v libx264 -g 100 -pix_fmt yuv420p");
  ffmpeg("-ss 0.5 -i '" + path("v.mp4") + "' -c copy '" + path("trimmed.mp4") + "'");
  const auto source = MediaSource::open(path("trimmed.mp4"));
  const auto frames = read_all(*source);
  EXPECT_EQ(static_cast<std::int64_t>(frames.size()), source->info().frame_count);
  EXPECT_LT(frames.size(), 20u);
  EXPECT_GE(frames.size(), 15u);
}

TEST_F(VideoIn, EveryContainerInUseReadsWithoutFalseAlarm) {
  const std::pair<const char*, const char*> kinds[] = {{"v.mkv", "-c:v libx264"},
                                                       {"v.avi", "-c:v mpeg4"},
                                                       {"v.ts", "-c:v libx264"},
                                                       {"v.webm", "-c:v libvpx -b:v 1M"},
                                                       {"v.flv", "-c:v flv"},
                                                       {"v.nut", "-c:v ffv1"},
                                                       {"v.mjpeg", "-c:v mjpeg"},
                                                       {"v.h264", "-c:v libx264"},
                                                       {"v.gif", ""},
                                                       {"f.mp4", "-c:v libx264 -movflags frag_keyframe+empty_moov"}};
  for (const auto& [name, options] : kinds) {
    SCOPED_TRACE(name);
    make(name, options);
    EXPECT_EQ(read_all(path(name)).size(), 20u);
  }
}

TEST_F(VideoIn, InterlacedFootageIsKnown) {
  const std::string make = "-f lavfi -i testsrc2=size=64x64:rate=50 -frames:v 8 -pix_fmt yuv420p ";
  ffmpeg(make + "-c:v libx264 '" + path("rows.mp4") + "'");
  ffmpeg(make + "-vf tinterlace=interleave_top -flags +ildct+ilme -x264-params tff=1 -c:v libx264 '" + path("fields.mp4") + "'");
  EXPECT_FALSE(MediaSource::open(path("rows.mp4"))->info().is_interlaced);
  EXPECT_TRUE(MediaSource::open(path("fields.mp4"))->info().is_interlaced);
}

}  // namespace
}  // namespace catchlight::app::testing
