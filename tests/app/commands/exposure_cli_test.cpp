// Footage whose exposure and white balance wander, as users overlay it: the drawn object's own pixels have to follow.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/ext/matrix_transform.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/projection.hpp"
#include "catchlight/track.hpp"
#include "render/probe/probe.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tracking/camera/camera_file.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 5;

/// 0, +1, 0, -1 EV and back, the white balance off by up to 20 % either way; at the top the tag's white is clipped in blue.
glm::dvec3 gain_of(int frame) {
  const double turn = 2 * M_PI * frame / (kFrames - 1);
  return std::exp2(std::sin(turn)) * glm::dvec3(1 + 0.2 * std::sin(1.3 * turn), 1, 1 + 0.2 * std::sin(0.9 * turn));
}

double light_of(int code) {
  return linear_from_srgb(code / 255.0);
}

/// The picture's light, re-exposed, with the noise of a sensor, clipped, in 8 bits.
cv::Mat reexposed(const cv::Mat& picture, const glm::dvec3& gain, int seed) {
  constexpr double kNoisePerLight = 2.3e-4;
  cv::Mat noise(picture.size(), CV_32FC3), result(picture.size(), CV_8UC3);
  cv::RNG(static_cast<std::uint64_t>(1000 + seed)).fill(noise, cv::RNG::NORMAL, 0, 1);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      for (int c = 0; c < 3; ++c) {
        const double light = light_of(picture.at<cv::Vec3b>(y, x)[c]) * gain[2 - c];
        const double seen = light + std::sqrt(kNoisePerLight * light) * static_cast<double>(noise.at<cv::Vec3f>(y, x)[c]);
        result.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(255 * srgb_from_linear(std::clamp(seen, 0.0, 1.0)));
      }
  return result;
}

/// A pyramid on the tag. Whatever is between its corners is seen within its outline.
constexpr std::array<glm::dvec3, 4> kPyramid_m = {{{-0.03, 0, -0.03}, {0.03, 0, -0.03}, {0, 0, 0.03}, {0, 0.06, 0}}};

class ExposureCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string shipped = CATCHLIGHT_SOURCE_DIR "/recordings/matte";
    fs::create_directories(folder_.path("decoded"));
    ASSERT_EQ(std::system(("ffmpeg -v error -nostdin -i " + shipped + "/video.mp4 -frames:v " + std::to_string(kFrames) +
                           " -start_number 0 " + folder_.path("decoded/%04d.png"))
                              .c_str()),
              0);
    const render::Probe probe =
        render::convert(render::load_probe(shipped + "/probe.exr", {}, {}), render::ProbeLayout::latlong, 64);
    for (const char* name : {"still", "wandering"}) {
      fs::create_directories(folder_.path(std::string(name) + "/plate"));
      for (const char* file : {"camera.yaml", "scene.toml"})
        fs::copy(shipped + "/" + file, folder_.path(std::string(name) + "/" + file));
      render::save_probe(folder_.path(std::string(name) + "/probe.exr"), probe);
      for (int frame = 0; frame < kFrames; ++frame)
        cv::imwrite(file(std::string(name) + "/plate", frame),
                    reexposed(cv::imread(file("decoded", frame)), name[0] == 's' ? glm::dvec3(1) : gain_of(frame), frame));
    }
    std::string mesh;
    for (const glm::dvec3& at : kPyramid_m)
      mesh += "v " + std::to_string(at.x) + " " + std::to_string(at.y) + " " + std::to_string(at.z) + "\n";
    folder_.write("pyramid.obj", mesh + "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  }

  std::string file(const std::string& folder, int frame) const {
    return folder_.path(folder + "/000" + std::to_string(frame) + ".png");
  }

  /// Pictures of `recording` with the pyramid in it, named NAME/%04d.png, and its track, NAME.csv.
  void overlay(const std::string& recording, const std::string& name, std::vector<std::string> more = {}) {
    fs::create_directories(folder_.path(name));
    std::vector<std::string> arguments = {"overlay",
                                          folder_.path(recording),
                                          "-o",
                                          folder_.path(name + "/%04d.png"),
                                          "--track-out",
                                          folder_.path(name + ".csv"),
                                          "--object.mesh",
                                          folder_.path("pyramid.obj"),
                                          "--glare.enabled=false",
                                          "--quality.rays=64",
                                          "--quality.bands=2",
                                          "--quality.bounces=0",
                                          "--quality.receiver_points=16",
                                          "--quality.reflection_rays=0",
                                          "--quality.samples=1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_catchlight(arguments, {{"XDG_CACHE_HOME", folder_.path("cache")}});
    ASSERT_EQ(result.exit_code, 0) << result.error;
  }

  /// Pixels within the pyramid's outline, well away from its edges.
  std::vector<cv::Point> object_pixels(const std::string& name, int frame) const {
    const CameraModel camera = tracking::read_camera_file(folder_.path("still/camera.yaml"));
    TrackRow row;
    for (const TrackRow& other : tracking::read_track_file(folder_.path(name + ".csv")).rows)
      if (other.frame == frame) row = other;
    EXPECT_TRUE(row.found) << frame;
    const glm::dmat3 stood_up = glm::dmat3(glm::rotate(glm::dmat4(1), glm::radians(12.0), glm::dvec3(0, 0, 1)) *
                                           glm::rotate(glm::dmat4(1), glm::radians(90.0), glm::dvec3(1, 0, 0)));
    const glm::dvec3 middle = 0.25 * (kPyramid_m[0] + kPyramid_m[1] + kPyramid_m[2] + kPyramid_m[3]);
    cv::RNG random(5);
    std::vector<cv::Point> pixels;
    for (int i = 0; i < 4000; ++i) {
      glm::dvec4 share(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
      share /= share.x + share.y + share.z + share.w;
      glm::dvec3 at(0);
      for (int corner = 0; corner < 4; ++corner) at += share[corner] * kPyramid_m[static_cast<std::size_t>(corner)];
      const auto seen = project_px(camera, row.camera_from_tag * (stood_up * glm::mix(middle, at, 0.8)));
      if (seen) pixels.emplace_back(cvRound(seen->x), cvRound(seen->y));
    }
    return pixels;
  }

  /// The ratio of linear light, `name` over `reference`, channel by channel (red first), over the object's unclipped pixels.
  glm::dvec3 brightening(const std::string& name, const std::string& reference, int frame) const {
    const cv::Mat after = cv::imread(file(name, frame)), before = cv::imread(file(reference, frame));
    glm::dvec3 bright(0), dark(0);
    for (const cv::Point& at : object_pixels(reference, frame))
      for (int c = 0; c < 3; ++c) {
        const double light = light_of(before.at<cv::Vec3b>(at)[c]);
        if (light * gain_of(frame)[2 - c] > 0.85) continue;
        dark[2 - c] += light;
        bright[2 - c] += light_of(after.at<cv::Vec3b>(at)[c]);
      }
    return bright / dark;
  }

  TemporaryFolder folder_;
};

TEST_F(ExposureCommand, TheObjectsPixelsFollowTheCameraWithinTwoPercent) {
  overlay("still", "before");
  overlay("wandering", "after");
  for (int frame = 0; frame < kFrames; ++frame) {
    const glm::dvec3 followed = brightening("after", "before", frame) / gain_of(frame);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(followed[c], 1, 0.02) << "frame " << frame << " channel " << c << " gain " << gain_of(frame)[c];
    }
  }
}

TEST_F(ExposureCommand, FixedDoesNotFollow) {
  overlay("still", "before", {"--exposure.mode=fixed", "--frames=1:2"});
  overlay("wandering", "after", {"--exposure.mode=fixed", "--frames=1:2"});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(brightening("after", "before", 1)[c], 1, 0.02) << "though the camera brightened";
}

TEST_F(ExposureCommand, TwentyStopsEitherWayAreWhiteAndBlack) {
  overlay("still", "white", {"--exposure.ev=20", "--frames=0"});
  overlay("still", "black", {"--exposure.ev=-20", "--frames=0"});
  const cv::Mat white = cv::imread(file("white", 0)), black = cv::imread(file("black", 0));
  for (const cv::Point& at : object_pixels("white", 0))
    for (int c = 0; c < 3; ++c) {
      ASSERT_EQ(white.at<cv::Vec3b>(at)[c], 255);
      ASSERT_LT(black.at<cv::Vec3b>(at)[c], 16) << "flare alone";
    }
}

}  // namespace
}  // namespace catchlight::tests
