// The window on footage that comes over the loopback, and on footage that is shorter than it says.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

using ::testing::HasSubstr;

const std::string kRecording = std::string(CATCHLIGHT_SOURCE_DIR) + "/recordings/matte";

/// A port of this machine that nobody uses now.
int free_port(int type) {
  const int descriptor = socket(AF_INET, type, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  EXPECT_EQ(bind(descriptor, any, length), 0);
  EXPECT_EQ(getsockname(descriptor, any, &length), 0);
  close(descriptor);
  return ntohs(address.sin_port);
}

class TuneLive : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }

  /// `tune` of an address while the shell does `feeding`, in which $FEED is the begin of an `ffmpeg` command that sends the
  /// shipped recording again and again, as fast as a camera does.
  CommandResult run(const std::string& address, const std::string& feeding, const std::string& script) {
    const std::string feed = "ffmpeg -v quiet -nostdin -re -stream_loop -1 -i " + kRecording + "/video.mp4 -q:v 2";
    const std::string command = "cd " + folder_.path("") + "; FEED='" + feed + "'; (" + feeding +
                                ") & timeout 240 " CATCHLIGHT_EXECUTABLE " tune '" + address + "' --scene " + kRecording +
                                "/scene.toml --camera " + kRecording + "/camera.yaml --headless --ui-script " +
                                folder_.write("script.txt", script) + "; code=$?; touch over; wait; exit $code";
    return run_program("/bin/sh", {"-c", command}, {});
  }

  /// Feeds `address` until the window has ended, in `format`; `meanwhile` may say something of the feeder, $!.
  static std::string feed(const std::string& format, const std::string& address, const std::string& meanwhile = "") {
    return "$FEED " + format + " '" + address + "' & " + meanwhile + " until [ -e over ]; do sleep 0.1; done; kill -9 $!";
  }

  TemporaryFolder folder_;
};

const std::string kTransport = "-c:v mpeg2video -g 12 -f mpegts";

TEST_F(TuneLive, ShowsAStreamAndRecordsATakeThatOverlayDraws) {
  const std::string address = "udp://127.0.0.1:" + std::to_string(free_port(SOCK_DGRAM));
  const CommandResult result = run(address, feed(kTransport, address + "?pkt_size=1316"),
                                   "wait source live\nwait\nexpect tag found\nexpect latency_ms > 0\nwait bake full\n"
                                   "set probe.yaw_deg 40\nwait\nclick undo\nexpect probe.yaw_deg 0\nset probe.ev 1\nwait\n"
                                   "expect take none\nclick take folder\nkey ctrl+a\ntype take\nclick record\n"
                                   "wait take recording\nwait take_frames > 5\nclick record\nwait take recorded\n"
                                   "click take folder\nkey ctrl+a\ntype take\nclick record\n"
                                   "wait message take exists already; name another folder to record into\n"
                                   "click play\nset probe.yaw_deg 20\nwait\npicture held.png\nwait\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_TRUE(std::filesystem::exists(path("held.png")));
  EXPECT_THAT(read_text(path("take/scene.toml")), HasSubstr("ev = 1\n"));
  const CommandResult drawn = run_catchlight({"overlay", path("take"), "-o", path("drawn.mp4"), "--frames", ":3"});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.error;
  EXPECT_THAT(drawn.error, HasSubstr("3 frames, 3 tracked"));
}

TEST_F(TuneLive, WaitsForAStreamThatStalls) {
  const std::string address = "udp://127.0.0.1:" + std::to_string(free_port(SOCK_DGRAM));
  const std::string stall =
      "until [ -e one.png -o -e over ]; do sleep 0.1; done; kill -STOP $!; "
      "until [ -e two.png -o -e over ]; do sleep 0.1; done; kill -CONT $!; ";
  const CommandResult result = run(address, feed(kTransport, address + "?pkt_size=1316", stall),
                                   "wait source live\nwait\nscreenshot one.png\nwait source waiting\nscreenshot two.png\n"
                                   "wait source live\nwait\nexpect tag found\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST_F(TuneLive, FindsASourceAgainThatWasLost) {
  const std::string address = "tcp://127.0.0.1:" + std::to_string(free_port(SOCK_STREAM));
  // A feeder that finds nobody listening ends at once. The first that is heard is ended, and another comes.
  const std::string feeding =
      "until [ -e over ]; do $FEED -c:v mjpeg -f nut '" + address +
      "' & until [ -e one.png -o -e over ] || ! kill -0 $! 2>/dev/null; do sleep 0.1; done; "
      "[ -e one.png ] && ! [ -e seen ] && touch seen && kill -9 $!; "
      "while [ -e seen ] && kill -0 $! 2>/dev/null && ! [ -e over ]; do sleep 0.1; done; done; kill -9 $!";
  const CommandResult result = run(address + "?listen=1", feeding,
                                   "wait source live\nwait\nexpect tag found\nscreenshot one.png\nwait source lost\n"
                                   "picture last.png\nwait source live\nwait\nexpect tag found\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_TRUE(std::filesystem::exists(path("last.png"))) << "the last picture stays";
}

TEST_F(TuneLive, ClosesWhileItWaitsForASourceThatNeverComes) {
  const std::string address = "udp://127.0.0.1:" + std::to_string(free_port(SOCK_DGRAM));
  const CommandResult result = run(address, "true", "wait source waiting\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST(TuneTruncated, ShowsWhatThereIsAndSaysSo) {
  const TemporaryFolder folder;
  for (const char* name : {"camera.yaml", "scene.toml", "object.glb", "probe.exr"})
    std::filesystem::copy_file(kRecording + "/" + name, folder.path(name));
  const std::string whole = folder.path("whole.mp4");
  const std::string make = "ffmpeg -v error -nostdin -i " + kRecording + "/video.mp4 -c copy -movflags +faststart " + whole;
  ASSERT_EQ(std::system(make.c_str()), 0);
  const std::string bytes = read_text(whole);
  folder.write("video.mp4", bytes.substr(0, bytes.size() / 2));
  std::filesystem::remove(whole);
  // The last line fails, and so says what the window says.
  const CommandResult result =
      run_catchlight({"tune", folder.path(""), "--headless", "--ui-script",
                      folder.write("script.txt",
                                   "wait\nexpect tag found\nkey end\nwait\nexpect frame > 5\nexpect frame < 30\n"
                                   "expect tag found\nkey home\nwait\nexpect frame 0\nexpect message so\n")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("script.txt:11: message is '"));
  EXPECT_THAT(result.error, HasSubstr("is damaged or cut short"));
}

}  // namespace
}  // namespace catchlight::tests
