// Exposure found against exposure made: a recording's frames, re-exposed by up to one stop and the white balance by up to 20 %,
// as CSV on standard output. What a channel found is given as gain, against the same frames as they are.
#include <cmath>
#include <cstdio>

#include "app/media/read/source.hpp"
#include "app/session/frame_track.hpp"
#include "catchlight/camera.hpp"
#include "tests/support/exposure_fixture.hpp"
#include "tracking/camera/camera_file.hpp"

namespace {

using namespace catchlight;

constexpr int kFrames = 36;

glm::dvec3 gain_of(int frame) {
  const double turn = 2 * M_PI * frame / (kFrames - 1);
  return std::exp2(std::sin(turn)) * glm::dvec3(1 + 0.2 * std::sin(1.3 * turn + 0.4), 1, 1 - 0.2 * std::sin(0.9 * turn + 1.1));
}

}  // namespace

int main() {
  const std::string folder = CATCHLIGHT_SOURCE_DIR "/recordings/matte";
  const CameraModel camera = tracking::read_camera_file(folder + "/camera.yaml");
  app::ShotTrack still(camera, {}), drifting(camera, {});
  const auto source = app::MediaSource::open(folder + "/video.mp4");
  for (int i = 0; i < kFrames; ++i) {
    const auto frame = source->read();
    if (!frame) break;
    still.add(*frame);
    drifting.add(app::testing::reexposed(*frame, gain_of(i)));
  }
  const auto before = still.solve(), after = drifting.solve();
  std::puts("frame,made_r,made_g,made_b,found_r,found_g,found_b");
  for (std::size_t i = 0; i < after.size(); ++i) {
    const glm::dvec3 made = gain_of(static_cast<int>(i)), found = after[i].exposure / before[i].exposure;
    std::printf("%zu,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n", i, made.r, made.g, made.b, found.r, found.g, found.b);
  }
}
