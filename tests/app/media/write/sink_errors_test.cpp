// What a sink refuses, and that nothing half-written is left under the output's name.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "catchlight/error.hpp"
#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

class SinkErrors : public MediaTest {
 protected:
  SinkErrors() {
    ffmpeg("-f lavfi -i testsrc2=size=160x120:rate=25:duration=1 -vf noise=alls=30:all_seed=1 -c:v libx264 '" + path("in.mp4") +
           "'");
  }

  // Passes through in a process whose files may not grow beyond `limit_bytes`; returns the error's message, or
  // nothing.
  std::string message_with_full_disk(const std::string& output, rlim_t limit_bytes) {
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0) return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{limit_bytes, limit_bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
      std::string message;
      try {
        pass_through(path("in.mp4"), path(output));
      } catch (const Error& error) {
        message = error.what();
      }
      if (write(pipe_ends[1], message.data(), message.size()) < 0) _exit(2);
      _exit(0);
    }
    close(pipe_ends[1]);
    std::string message(4096, '\0');
    const ssize_t got = ::read(pipe_ends[0], message.data(), message.size());
    message.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    close(pipe_ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    return message;
  }
};

SinkOptions options_for(const FrameRange& frames, bool overwrite = false) {
  SinkOptions options;
  options.frames = frames;
  options.overwrite = overwrite;
  return options;
}

TEST_F(SinkErrors, ExistingOutputIsKept) {
  write_bytes(path("out.mp4"), {1, 2, 3});
  EXPECT_THAT(message_of<UsageError>([&] { pass_through(path("in.mp4"), path("out.mp4")); }), HasSubstr("exists already"));
  EXPECT_EQ(bytes_of(path("out.mp4")).size(), 3u);
  SinkOptions overwrite;
  overwrite.overwrite = true;
  pass_through(path("in.mp4"), path("out.mp4"), overwrite);
  EXPECT_EQ(read_all(path("out.mp4")).size(), 25u);
}

TEST_F(SinkErrors, OutputEqualToTheInputUnderAnyName) {
  std::filesystem::create_symlink(path("in.mp4"), path("link.mp4"));
  std::filesystem::create_hard_link(path("in.mp4"), path("hard.mp4"));
  SinkOptions overwrite;
  overwrite.overwrite = true;
  const auto before = bytes_of(path("in.mp4"));
  for (const char* name : {"in.mp4", "./in.mp4", "link.mp4", "hard.mp4"}) {
    EXPECT_THAT(message_of<UsageError>([&] { pass_through(path("in.mp4"), path(name), overwrite); }), HasSubstr("input itself"));
  }
  EXPECT_EQ(bytes_of(path("in.mp4")), before);
}

TEST_F(SinkErrors, UnknownExtensionsAreAnsweredWithTheKnown) {
  for (const char* name : {"out.xyz", "out", "out.png", "out.%04d.jpg"}) {
    const std::string message = message_of<UsageError>([&] { pass_through(path("in.mp4"), path(name)); });
    EXPECT_THAT(message, HasSubstr(name));
    EXPECT_THAT(message, HasSubstr(".png"));
  }
  EXPECT_THAT(files(), ElementsAre("in.mp4"));
}

TEST_F(SinkErrors, UnknownCodecsAndPresets) {
  SinkOptions options;
  options.codec = "h266";
  EXPECT_THAT(message_of<UsageError>([&] { pass_through(path("in.mp4"), path("out.mp4"), options); }),
              HasSubstr("h264 and ffv1"));
  options = {};
  options.preset = "quick";
  EXPECT_THAT(message_of<UsageError>([&] { pass_through(path("in.mp4"), path("out.mp4"), options); }), HasSubstr("quick"));
  options = {};
  options.crf = 52;
  EXPECT_THAT(message_of<UsageError>([&] { pass_through(path("in.mp4"), path("out.mp4"), options); }), HasSubstr("52"));
  EXPECT_THAT(files(), ElementsAre("in.mp4"));
}

TEST_F(SinkErrors, FilesOfASequenceAreNoticedBeforeTheFirstFrame) {
  write_bytes(path("out.0031.png"), {1, 2, 3});  // the footage ends before it
  write_bytes(path("out.0007.png"), {1, 2, 3});
  write_bytes(path("out.0009.png"), {1, 2, 3});
  const auto source = MediaSource::open(path("in.mp4"));
  const auto open = [&](const SinkOptions& options) { MediaSink::open(path("out.%04d.png"), path("in.mp4"), *source, options); };
  EXPECT_THAT(message_of<UsageError>([&] { open({}); }), HasSubstr("out.0007.png: exists already; pass -y"));
  EXPECT_THAT(message_of<UsageError>([&] { open(options_for({8, 25})); }), HasSubstr("out.0009.png: exists already"));
  EXPECT_NO_THROW(open(options_for({0, 7})));
  EXPECT_NO_THROW(open(options_for({10, 40})));
  EXPECT_NO_THROW(open(options_for({}, true)));
  EXPECT_THAT(files(), ElementsAre("in.mp4", "out.0007.png", "out.0009.png", "out.0031.png"));
}

TEST_F(SinkErrors, FolderAmongTheFilesOfASequenceIsNoticedEvenForOverwriting) {
  std::filesystem::create_directories(path("out.0007.png"));
  const auto source = MediaSource::open(path("in.mp4"));
  EXPECT_THAT(
      message_of<UsageError>([&] { MediaSink::open(path("out.%04d.png"), path("in.mp4"), *source, options_for({}, true)); }),
      HasSubstr("out.0007.png: is a folder"));
}

TEST_F(SinkErrors, MissingFolder) {
  EXPECT_THAT(message_of<Error>([&] { pass_through(path("in.mp4"), path("none/out.mp4")); }), HasSubstr("no folder"));
  EXPECT_THAT(message_of<Error>([&] { pass_through(path("in.mp4"), path("none/%04d.png")); }), HasSubstr("no folder"));
}

TEST_F(SinkErrors, UnwritableFolder) {
  // Nobody, root included, can make files there.
  EXPECT_THAT(message_of<Error>([&] { pass_through(path("in.mp4"), "/proc/out.mp4"); }), HasSubstr("/proc"));
}

TEST_F(SinkErrors, UnfinishedOutputIsRemoved) {
  {
    const auto source = MediaSource::open(path("in.mp4"));
    const auto sink = MediaSink::open(path("out.mp4"), path("in.mp4"), *source, {});
    EXPECT_THAT(files(), ElementsAre(MatchesRegex("\\.out\\.partial-[0-9]+\\.mp4"), "in.mp4"));
    while (auto frame = source->read()) sink->write(*frame);
  }
  EXPECT_THAT(files(), ElementsAre("in.mp4"));
}

TEST_F(SinkErrors, NoFrameIsNoVideo) {
  const auto source = MediaSource::open(path("in.mp4"));
  {
    const auto sink = MediaSink::open(path("out.mp4"), path("in.mp4"), *source, {});
    EXPECT_THROW(sink->finish(), Error);
  }
  EXPECT_THAT(files(), ElementsAre("in.mp4"));
}

TEST_F(SinkErrors, AFullDiskIsReportedAndLeavesNothing) {
  for (const char* name : {"out.mp4", "out.mkv", "out.nut", "out.y4m", "out.%02d.png"}) {
    const std::string message = message_with_full_disk(name, 20000);
    EXPECT_THAT(message, HasSubstr("cannot write")) << name;
    EXPECT_THAT(files(), ElementsAre("in.mp4")) << name;
  }
}

// The last bytes reach the disk when the file is closed.
TEST_F(SinkErrors, ADiskThatIsFullOnlyAtTheVeryEnd) {
  for (const char* name : {"out.mp4", "out.mkv", "out.nut"}) {
    pass_through(path("in.mp4"), path(name));
    const auto size = bytes_of(path(name)).size();
    std::filesystem::remove(path(name));
    EXPECT_THAT(message_with_full_disk(name, size - 1), HasSubstr("cannot write")) << name;
    EXPECT_THAT(files(), ElementsAre("in.mp4")) << name;
    EXPECT_EQ(message_with_full_disk(name, size), "") << name;
    std::filesystem::remove(path(name));
  }
}

TEST_F(SinkErrors, StdoutThatIsFull) {
  const int saved = dup(STDOUT_FILENO), full = open("/dev/full", O_WRONLY);
  dup2(full, STDOUT_FILENO);
  const std::string message = message_of<Error>([&] { pass_through(path("in.mp4"), "-"); });
  dup2(saved, STDOUT_FILENO);
  close(saved);
  close(full);
  EXPECT_THAT(message, HasSubstr("No space left"));
}

}  // namespace
}  // namespace catchlight::app::testing
