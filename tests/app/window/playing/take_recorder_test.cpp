// Takes of live footage: what is in the folder is what came in.
#include "app/window/playing/take_recorder.hpp"

#include <gmock/gmock.h>

#include "catchlight/error.hpp"
#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Take : public MediaTest {
 protected:
  Take() {
    ffmpeg("-f lavfi -i testsrc2=size=160x120:rate=10:duration=1 -vf noise=alls=20:all_seed=3 -c:v ffv1 -pix_fmt yuv420p '" +
           path("in.mkv") + "'");
    live_.footage = "udp://127.0.0.1:1";
    live_.fov_deg = 60;
    live_.scene.probe.image = "probe.exr";
    live_.scene.by_hand = {"probe.image"};
    live_.scene.folder = path("scenes");
  }

  /// Records the frames of in.mkv.
  TakeStatus record(const std::string& folder) {
    const auto source = MediaSource::open(path("in.mkv"));
    TakeRecorder recorder(folder, live_, source->info());
    for (const Frame& frame : read_all(*source)) recorder.add(frame);
    recorder.stop();
    while (!recorder.status().is_over) std::this_thread::yield();
    return recorder.status();
  }

  Recording live_;
};

TEST_F(Take, HasEverySampleThatCameIn) {
  const TakeStatus status = record(path("take"));
  EXPECT_EQ(status.error, std::nullopt);
  EXPECT_EQ(status.written, 10);
  EXPECT_EQ(status.left_out, 0);
  const std::vector<Frame> in = read_all(path("in.mkv")), out = read_all(path("take/video.mkv"));
  ASSERT_EQ(in.size(), out.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    EXPECT_EQ(samples_of(in[i].picture()), samples_of(out[i].picture())) << i;
    EXPECT_NEAR(in[i].time_s(), out[i].time_s(), 1e-3) << i;
  }
}

TEST_F(Take, IsARecordingWithItsCameraAndScene) {
  record(path("take"));
  const Recording recording = open_recording(path("take"));
  EXPECT_NEAR(camera_for_footage(recording, 160, 120).fx_px, camera_for_footage(live_, 160, 120).fx_px, 1e-6);
  EXPECT_EQ(recording.scene.resolve(recording.scene.probe.image), path("scenes/probe.exr")) << "found from elsewhere, too";
}

TEST_F(Take, NeverGoesIntoAFolderThatExists) {
  record(path("take"));
  const auto before = bytes_of(path("take/video.mkv"));
  EXPECT_THAT(message_of<Error>([&] { record(path("take")); }), HasSubstr("take exists already"));
  EXPECT_EQ(bytes_of(path("take/video.mkv")), before);
}

TEST_F(Take, LeavesNothingWhereNoFrameCame) {
  { TakeRecorder recorder(path("take"), live_, MediaSource::open(path("in.mkv"))->info()); }
  EXPECT_THAT(files(), ElementsAre("in.mkv"));
}

}  // namespace
}  // namespace catchlight::app::testing
