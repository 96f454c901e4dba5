// Videos out: times, sound, tags, sameness.
#include <gmock/gmock.h>

#include "catchlight/error.hpp"
#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class VideoOut : public MediaTest {
 protected:
  std::vector<std::string> sorted_lines(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      lines.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    std::sort(lines.begin(), lines.end());
    return lines;
  }
  std::vector<std::string> video_times(const std::string& file) {
    return sorted_lines(ffprobe(file, "-select_streams v -show_entries packet=pts"));
  }
  std::vector<std::string> audio_packets(const std::string& file, const std::string& what = "packet=data_hash") {
    return sorted_lines(ffprobe(file, "-select_streams a -show_data_hash md5 -show_entries " + what));
  }
};

// 24 frames at uneven times, in ticks of 1/90000 s.
TEST_F(VideoOut, VariableFrameTimesSurviveExactly) {
  ffmpeg(
      "-f lavfi -i testsrc2=size=64x48:rate=30:duration=1 -vf \"setpts='(N*3003+mod(N*N*377,1900))',settb=1/90000\" -frames:v 24 "
      "-vsync vfr -enc_time_base 1/90000 -video_track_timescale 90000 -c:v libx264 '" +
      path("in.mp4") + "'");
  const auto times = video_times(path("in.mp4"));
  ASSERT_EQ(times.size(), 24u);
  pass_through(path("in.mp4"), path("out.mp4"));
  pass_through(path("in.mp4"), path("out.mov"));
  EXPECT_EQ(video_times(path("out.mp4")), times);
  EXPECT_EQ(video_times(path("out.mov")), times);
  EXPECT_EQ(ffprobe(path("out.mp4"), "-select_streams v -show_entries stream=time_base"), "1/90000\n");
}

TEST_F(VideoOut, NtscRateStaysAFraction) {
  ffmpeg("-f lavfi -i testsrc2=size=64x48:rate=30000/1001 -frames:v 10 -c:v libx264 '" + path("in.mp4") + "'");
  pass_through(path("in.mp4"), path("out.mp4"));
  pass_through(path("in.mp4"), path("out.mkv"));
  for (const char* name : {"out.mp4", "out.mkv"}) {
    EXPECT_EQ(ffprobe(path(name), "-select_streams v -show_entries stream=avg_frame_rate"), "30000/1001\n");
  }
}

TEST_F(VideoOut, AudioIsCarriedOverPacketByPacket) {
  ffmpeg(
      "-f lavfi -i testsrc2=size=64x48:rate=25:duration=2 -f lavfi -i sine=duration=2 -f lavfi -i sine=frequency=880:duration=2 "
      "-map 0 -map 1 -map 2 -c:v libx264 -c:a aac '" +
      path("in.mp4") + "'");
  for (const char* name : {"out.mp4", "out.mkv"}) {
    SCOPED_TRACE(name);
    pass_through(path("in.mp4"), path(name));
    EXPECT_EQ(ffprobe(path(name), "-select_streams a -show_entries stream=codec_name"), "aac\naac\n");
  }
  EXPECT_EQ(audio_packets(path("out.mp4")), audio_packets(path("in.mp4")));
  EXPECT_EQ(audio_packets(path("out.mp4"), "packet=pts"), audio_packets(path("in.mp4"), "packet=pts"));
}

TEST_F(VideoOut, APartOfTheFramesGetsItsPartOfTheSound) {
  ffmpeg(
      "-f lavfi -i testsrc2=size=64x48:rate=25:duration=4 -f lavfi -i 'aevalsrc=sin(300*t*t):d=4' -c:v libx264 -c:a pcm_s16le '" +
      path("in.mov") + "'");
  pass_through(path("in.mov"), path("out.mov"), {}, 25, 75);
  EXPECT_THAT(ffprobe(path("out.mov"), "-select_streams v -show_entries stream=start_time,nb_frames"), HasSubstr("0.000000,50"));
  ffmpeg("-i '" + path("out.mov") + "' -vn -f s16le '" + path("out.pcm") + "'");
  ffmpeg("-i '" + path("in.mov") + "' -vn -f s16le '" + path("in.pcm") + "'");
  const auto all = bytes_of(path("in.pcm")), part = bytes_of(path("out.pcm"));
  // Packets stay whole: the part begins and ends within one (1024 samples) of second 1 and second 3, and its times say where.
  const double start_s = std::stod(ffprobe(path("out.mov"), "-select_streams a -show_entries stream=start_time"));
  EXPECT_GE(start_s, 0);
  EXPECT_LE(start_s, 1024 / 44100.0);
  const auto offset = static_cast<std::ptrdiff_t>(std::lround((1 + start_s) * 44100)) * 2;
  ASSERT_LE(static_cast<std::size_t>(offset) + part.size(), all.size());
  EXPECT_TRUE(std::equal(part.begin(), part.end(), all.begin() + offset));
  EXPECT_NEAR(static_cast<double>(part.size()) / 2 / 44100, 2, 2 * 1024 / 44100.0);
}

TEST_F(VideoOut, SoundThatTheContainerCannotHoldIsRefusedByName) {
  ffmpeg("-f lavfi -i testsrc2=size=64x48:rate=25:duration=1 -f lavfi -i sine=duration=1 -c:v libx264 -c:a pcm_s16le '" +
         path("in.mov") + "'");
  const std::string message = message_of<Error>([&] { pass_through(path("in.mov"), path("out.mp4")); });
  EXPECT_THAT(message, HasSubstr("pcm_s16le"));
  EXPECT_THAT(message, HasSubstr(".mkv"));
  EXPECT_THAT(files(), ElementsAre("in.mov"));
  pass_through(path("in.mov"), path("out.mkv"));
}

TEST_F(VideoOut, ColourTagsAndAspectAreWritten) {
  ffmpeg(
      "-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 3 -vf setsar=4/3 -pix_fmt yuv420p -colorspace bt709 -color_primaries "
      "bt709 -color_trc bt709 "
      "-color_range tv -chroma_sample_location left -c:v libx264 '" +
      path("in.mp4") + "'");
  const std::string entries =
      "-show_entries stream=sample_aspect_ratio,pix_fmt,color_range,color_space,color_transfer,color_primaries,chroma_location";
  for (const char* name : {"out.mp4", "out.mkv"}) {
    pass_through(path("in.mp4"), path(name));
    EXPECT_EQ(ffprobe(path(name), entries), ffprobe(path("in.mp4"), entries)) << name;
  }
}

TEST_F(VideoOut, TitleCreationTimeAndTimecodeAreCarriedOver) {
  ffmpeg(
      "-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 30 -timecode 01:02:03:20 -metadata title='Shot 7' -metadata "
      "creation_time=2024-05-06T07:08:09Z -c:v libx264 '" +
      path("in.mov") + "'");
  pass_through(path("in.mov"), path("whole.mov"));
  pass_through(path("in.mov"), path("whole.mp4"));
  pass_through(path("in.mov"), path("part.mov"), {}, 10, 20);
  for (const char* name : {"whole.mov", "whole.mp4", "part.mov"}) {
    const std::string tags = ffprobe(path(name), "-show_entries format_tags=title,creation_time");
    EXPECT_THAT(tags, HasSubstr("Shot 7")) << name;
    EXPECT_THAT(tags, HasSubstr("2024-05-06T07:08:09")) << name;
    EXPECT_THAT(ffprobe(path(name), "-select_streams v -show_entries stream_tags=timecode"),
                HasSubstr(std::string(name) == "part.mov" ? "01:02:04:05" : "01:02:03:20"))
        << name;
  }
}

TEST_F(VideoOut, FullRangeAndDepthAreKept) {
  for (const char* format : {"yuv420p", "yuv422p", "yuv444p", "yuv420p10le", "yuv422p10le"}) {
    SCOPED_TRACE(format);
    ffmpeg(std::string(
               "-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 3 -color_range pc -colorspace smpte170m -c:v ffv1 -pix_fmt ") +
           format + " '" + path("in.mkv") + "'");
    SinkOptions options;
    options.overwrite = true;
    options.crf = 12;
    pass_through(path("in.mkv"), path("out.mp4"), options);
    const Frame in = read_all(path("in.mkv")).at(0), out = read_all(path("out.mp4")).at(0);
    EXPECT_EQ(in.picture().format, out.picture().format);
    EXPECT_EQ(in.luma().white_code, out.luma().white_code);
    double difference = 0;
    const auto a = samples_of(in.picture()), b = samples_of(out.picture());
    const bool deep = pixel_layout(in.picture().format)->depth() > 8;
    for (std::size_t i = 0; i < a.size(); i += deep ? 2 : 1)
      difference += std::abs(deep ? (a[i] | a[i + 1] << 8) - (b[i] | b[i + 1] << 8) : a[i] - b[i]);
    EXPECT_LT(difference / static_cast<double>(a.size()), 2.0);  // the encoder's loss; a lost range would be 10 and more
  }
}

TEST_F(VideoOut, LosslessOutputHoldsTheDecodersSamples) {
  for (const char* format : {"yuv420p", "yuv422p10le", "yuv444p", "bgr0", "gray"}) {
    SCOPED_TRACE(format);
    ffmpeg(std::string("-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 3 -c:v ffv1 -pix_fmt ") + format + " '" +
           path("in.nut") + "'");
    SinkOptions options;
    options.overwrite = true;
    pass_through(path("in.nut"), path("out.nut"), options);
    const auto in = read_all(path("in.nut")), out = read_all(path("out.nut"));
    ASSERT_EQ(out.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(samples_of(in[i].picture()), samples_of(out[i].picture()));
  }
}

TEST_F(VideoOut, CameraFormatsAndOddSizesCanBeWritten) {
  const std::pair<const char*, const char*> kinds[] = {
      {"yuyv422", "64x48"}, {"nv12", "64x48"}, {"rgb24", "64x48"}, {"yuv420p", "63x47"}, {"rgb48le", "64x48"}};
  for (const auto& [format, size] : kinds) {
    SCOPED_TRACE(format);
    ffmpeg("-f lavfi -i testsrc=size=" + std::string(size) + ":rate=25 -frames:v 3 -vf format=" + format + " -pix_fmt " + format +
           " -c:v rawvideo '" + path("in.nut") + "'");
    SinkOptions options;
    options.overwrite = true;
    pass_through(path("in.nut"), path("out.mp4"), options);
    EXPECT_EQ(read_all(path("out.mp4")).size(), 3u);
  }
}

TEST_F(VideoOut, LinearFloatsAreShownAsSrgb) {
  ffmpeg("-f lavfi -i color=c=white:size=64x48:rate=24 -frames:v 2 -vf format=gbrpf32le '" + path("f.%02d.exr") + "'");
  pass_through(path("f.%02d.exr"), path("o.%02d.png"));
  EXPECT_EQ(samples_of(read_all(path("o.%02d.png"))[0].picture())[0], 255);
  pass_through(path("f.%02d.exr"), path("o.mp4"));
  const Frame frame = read_all(path("o.mp4")).at(0);
  EXPECT_NEAR(frame.luma().data[10 * frame.luma().stride + 10], 235, 1);  // limited-range white, less the encoder's loss
}

TEST_F(VideoOut, TwoRunsGiveTheSameBytes) {
  ffmpeg("-f lavfi -i testsrc2=size=320x240:rate=25:duration=2 -f lavfi -i sine=duration=2 -c:v libx264 -c:a aac '" +
         path("in.mp4") + "'");
  for (const char* extension : {".mp4", ".mkv", ".nut", ".y4m"}) {
    pass_through(path("in.mp4"), path(std::string("a") + extension));
    pass_through(path("in.mp4"), path(std::string("b") + extension));
    EXPECT_EQ(bytes_of(path(std::string("a") + extension)), bytes_of(path(std::string("b") + extension))) << extension;
  }
}

TEST_F(VideoOut, Mp4CanBePlayedWhileItLoads) {
  ffmpeg("-f lavfi -i testsrc2=size=64x48:rate=25:duration=1 -c:v libx264 '" + path("in.mp4") + "'");
  pass_through(path("in.mp4"), path("out.mp4"));
  const auto bytes = bytes_of(path("out.mp4"));
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_LT(all.find("moov"), all.find("mdat"));
}

TEST_F(VideoOut, LevelFollowsTheRateNotTheTicks) {
  ffmpeg("-f lavfi -i testsrc2=size=640x480:rate=25 -frames:v 5 -video_track_timescale 90000 -c:v libx264 '" + path("in.mp4") +
         "'");
  pass_through(path("in.mp4"), path("out.mp4"));
  EXPECT_EQ(ffprobe(path("out.mp4"), "-select_streams v -show_entries stream=level"),
            "30\n");  // 3.0: 640x480 up to 33.75 frames a second
}

TEST_F(VideoOut, Y4mHoldsTheSamplesAndTheRate) {
  ffmpeg("-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 4 -pix_fmt yuv420p -c:v libx264 '" + path("in.mp4") + "'");
  pass_through(path("in.mp4"), path("out.y4m"));
  const auto in = read_all(path("in.mp4")), out = read_all(path("out.y4m"));
  ASSERT_EQ(out.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(samples_of(in[i].picture()), samples_of(out[i].picture()));
  const auto bytes = bytes_of(path("out.y4m"));
  EXPECT_THAT(std::string(bytes.begin(), bytes.begin() + 60), HasSubstr("W64 H48 F25:1"));
}

/// Footage that says to be live, whatever it is.
class LiveSource : public MediaSource {
 public:
  explicit LiveSource(std::unique_ptr<MediaSource> source) : source_(std::move(source)), info_(source_->info()) {
    info_.is_live = info_.is_one_pass = true;
  }
  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> read() override { return source_->read(); }
  const AVStream* video_stream() const override { return source_->video_stream(); }

 private:
  std::unique_ptr<MediaSource> source_;
  SourceInfo info_;
};

/// y4m has no times: what is dropped of a camera's frames must not shorten the film.
TEST_F(VideoOut, Y4mOfLiveFootageRepeatsFramesWhereSomeWereDropped) {
  ffmpeg("-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 7 -pix_fmt yuv420p -c:v libx264 '" + path("in.mp4") + "'");
  LiveSource source(MediaSource::open(path("in.mp4")));
  const auto sink = MediaSink::open(path("out.y4m"), path("in.mp4"), source, {});
  while (auto frame = source.read())
    if (frame->number() % 3 == 0) sink->write(*frame);
  sink->finish();
  const auto in = read_all(path("in.mp4")), out = read_all(path("out.y4m"));
  ASSERT_EQ(out.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(samples_of(out[i].picture()), samples_of(in[i / 3 * 3].picture())) << i;
}

}  // namespace
}  // namespace catchlight::app::testing
