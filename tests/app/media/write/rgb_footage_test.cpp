// What becomes of RGB footage in files for players.
#include <gmock/gmock.h>

#include "catchlight/error.hpp"
#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

using ::testing::HasSubstr;

class RgbFootage : public MediaTest {
 protected:
  /// A numbered picture of one colour.
  std::string flat(const std::string& size, const std::string& format = "rgb24") {
    ffmpeg("-f lavfi -i color=c=0xC83C14:rate=24 -frames:v 2 -vf format=rgb24,scale=" + size + " -pix_fmt " + format + " '" +
           path("f.%04d.png") + "'");
    return path("f.%04d.png");
  }

  /// The middle pixel of the first frame, as the ffmpeg command decodes the file.
  std::vector<int> color_by_ffmpeg(const std::string& file) {
    ffmpeg("-i '" + file +
           "' -frames:v 1 -sws_flags accurate_rnd+full_chroma_int -vf format=rgb24,crop=1:1 -f rawvideo -pix_fmt rgb24 '" +
           path("color.rgb") + "'");
    const auto bytes = bytes_of(path("color.rgb"));
    std::filesystem::remove(path("color.rgb"));
    return {bytes.begin(), bytes.end()};
  }

  std::string format_of(const std::string& name) { return ffprobe(path(name), "-show_entries stream=pix_fmt"); }
};

/// Nearest would be 4:4:4, which QuickTime, browsers and phones refuse.
TEST_F(RgbFootage, IsHalfColourResolutionForPlayers) {
  for (const char* depth : {"rgb24", "rgba", "rgb48be"}) {
    const std::string footage = flat("64:48", depth);
    for (const char* name : {"out.mp4", "out.mov", "out.y4m"}) {
      pass_through(footage, path(name), {.overwrite = true});
      EXPECT_EQ(format_of(name), "yuv420p\n") << name << " of " << depth;
    }
  }
  pass_through(path("f.%04d.png"), path("out.mkv"));
  EXPECT_THAT(format_of("out.mkv"), HasSubstr("yuv444p")) << "an archive keeps what it can";
}

/// y4m says no matrix; small or large, ffmpeg takes BT.601 for granted. .mp4 says BT.709.
TEST_F(RgbFootage, HasItsColoursInWhatFfmpegReads) {
  for (const char* size : {"64:48", "1280:720"}) {
    const std::string footage = flat(size);
    for (const char* name : {"out.mp4", "out.y4m"}) {
      pass_through(footage, path(name), {.overwrite = true});
      const std::vector<int> color = color_by_ffmpeg(path(name));
      ASSERT_EQ(color.size(), 3u);
      EXPECT_NEAR(color[0], 0xC8, 3) << name << ' ' << size;
      EXPECT_NEAR(color[1], 0x3C, 3) << name << ' ' << size;
      EXPECT_NEAR(color[2], 0x14, 3) << name << ' ' << size;
    }
    EXPECT_EQ(ffprobe(path("out.mp4"), "-show_entries stream=color_range,color_space"), "tv,bt709\n");
  }
}

TEST_F(RgbFootage, OddSizesKeepFullColourResolution) {
  pass_through(flat("63:47"), path("out.mp4"));
  EXPECT_EQ(format_of("out.mp4"), "yuv444p\n");
}

TEST_F(RgbFootage, GetsThePixelFormatThatIsAskedFor) {
  const std::string footage = flat("64:48");
  for (const auto& [name, format] :
       {std::pair{"a.mp4", "yuv444p"}, {"b.mp4", "yuv420p10"}, {"c.y4m", "yuv422p"}, {"d.nut", "gbrp16"}}) {
    pass_through(footage, path(name), {.pixel_format = format});
    EXPECT_THAT(format_of(name), HasSubstr(format));
  }
  pass_through(footage, path("e.%04d.png"), {.pixel_format = "rgb48be"});
  EXPECT_EQ(format_of("e.0001.png"), "rgb48be\n");
}

TEST_F(RgbFootage, APixelFormatThatTheCodecLacksIsRefusedBeforeTheWork) {
  const std::string footage = flat("64:48");
  const auto source = MediaSource::open(footage);
  const auto opened = [&](const char* name, const char* format) {
    return [&, name, format] { MediaSink::open(path(name), footage, *source, {.pixel_format = format}); };
  };
  EXPECT_THAT(message_of<UsageError>(opened("a.mp4", "yuv420")),
              HasSubstr("--pixel-format yuv420: H.264 of 64x48 cannot have it"));
  EXPECT_THAT(message_of<UsageError>(opened("a.mp4", "rgb24")), HasSubstr("expected \"yuv420p\""));
  EXPECT_THAT(message_of<UsageError>(opened("a.%04d.png", "yuv420p")), HasSubstr("PNG"));
}

}  // namespace
}  // namespace catchlight::app::testing
