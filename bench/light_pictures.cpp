// The pictures of docs/light.md: a recording's probe as lights and rest, and one frame of it in the light of each. Writes
// FOLDER/light_probe.jpg (probe | lights | rest, and below it the same darker), light_parts.jpg (frame in the lights alone | in
// the rest alone | in both) and light_truth.jpg (both | truth | difference x 8).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/session/session.hpp"
#include "catchlight/color.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/gl_compositor.hpp"
#include "render/probe/probe_split.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"

namespace {

using namespace catchlight;
using namespace catchlight::app;

constexpr int kFrame = 16;
constexpr int kWidth = 1200;                              // width of the pictures
constexpr double kBrightProbe = 0.24, kDarkProbe = 0.01;  // exposures

struct Part {
  render::RenderScene scene;
  glm::dvec3 share;  ///< the part's share of the light on the tag
};

Image exposed(const Layers& layers, const glm::dvec3& gain) {
  Image linear = recompose(layers);
  for (int y = 0; y < linear.height; ++y)
    for (int x = 0; x < linear.width; ++x)
      for (int c = 0; c < 3; ++c) linear.pixel(x, y)[c] *= static_cast<float>(gain[c]);
  return linear;
}

cv::Mat coded(const Image& linear, double gain) {
  cv::Mat codes(linear.height, linear.width, CV_8UC3);
  for (int y = 0; y < codes.rows; ++y) {
    for (int x = 0; x < codes.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double value = std::clamp(gain * linear.pixel(x, y)[c], 0.0, 1.0);
        codes.at<cv::Vec3b>(y, x)[2 - c] = static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(value)));
      }
    }
  }
  return codes;
}

render::Probe difference(const render::Probe& whole, const render::Probe& rest) {
  render::Probe lights = whole;
  for (std::size_t i = 0; i < lights.image.data.size(); ++i) lights.image.data[i] -= rest.image.data[i];
  return lights;
}

Recording without_glare(const std::string& location) {
  Recording recording = open_recording(location);
  recording.scene.glare.enabled = false;  // the truth has none
  return recording;
}

SessionOptions with_layers() {
  SessionOptions options;
  options.range = {kFrame, kFrame + 1};
  options.wants_layers = true;
  return options;
}

class Studio {
 public:
  explicit Studio(const std::string& location) : session_(without_glare(location), with_layers(), log_) {
    session_.prepare();
    do job_ = session_.decode().value();
    while (session_.track(*job_), job_->is_before_range);
    session_.view(*job_);
    if (!job_->track.found) throw Error(location + ": no tag in frame " + std::to_string(kFrame));
  }

  const BuiltScene& built() const { return session_.renderer().builder().scene(); }
  const SceneSettings& settings() const { return session_.settings(); }

  /// The light on the tag that `probe` brings.
  glm::dvec3 share_of(const render::Probe& probe) const {
    const glm::dvec3 up = glm::transpose(built().orientation.light_from_probe) * glm::dvec3(0, 0, 1);
    return render::irradiance(probe, up) / glm::pi<double>() / built().still_irradiance_over_pi;
  }

  /// The whole frame, linear, as if the place had that part of its light alone: the plate is that much darker, and what is
  /// exposed by the tag on it that much brighter, before all of it is put back to the exposure of the whole.
  Image frame(const Part& part) {
    render::FrameView view = job_->view;
    view.exposure /= glm::vec3(part.share);
    const auto plate = [&](const PixelRect& rect) { return job_->image.rgb(rect); };
    render::GlCompositor compositor(part.scene, compositor_settings(settings()));
    return exposed(*compositor.render(view, plate, true).layers, part.share);
  }

  cv::Mat truth() const {
    const std::string file = session_.recording().truth_folder.value_or("") + "/0016.png";
    cv::Mat picture = cv::imread(file, cv::IMREAD_COLOR);
    if (picture.empty()) throw Error(file + ": cannot be read");
    return picture;
  }

 private:
  Log log_;
  Session session_;
  std::optional<FrameJob> job_;
};

Part lights_alone(const Studio& studio, const render::SplitProbe& split) {
  const glm::dmat3& turn = studio.built().orientation.light_from_probe;
  const render::Probe lights = difference(studio.built().probe, split.rest);
  Part part{studio.built().scene, studio.share_of(lights)};
  part.scene.light = render::project_to_sh(part.scene.lights, part.scene.transfer.bands);
  part.scene.reflections = render::prefilter_reflections(lights, turn);
  part.scene.rest_reflections = render::prefilter_reflections(difference(split.mirrored, split.rest), turn);
  return part;
}

Part rest_alone(const Studio& studio, const render::SplitProbe& split) {
  Part part{studio.built().scene, studio.share_of(split.rest)};
  const render::ShRgb lights = render::project_to_sh(part.scene.lights, part.scene.transfer.bands);
  for (std::size_t i = 0; i < lights.size(); ++i) part.scene.light[i] -= lights[i];
  part.scene.reflections = render::prefilter_reflections(split.rest, studio.built().orientation.light_from_probe);
  part.scene.lights.clear();
  part.scene.rest_reflections = {};
  return part;
}

void write(const std::string& path, const std::vector<cv::Mat>& side_by_side) {
  cv::Mat row, picture;
  cv::hconcat(side_by_side, row);
  cv::resize(row, picture, {kWidth, row.rows * kWidth / row.cols}, 0, 0, cv::INTER_AREA);
  if (!cv::imwrite(path, picture, {cv::IMWRITE_JPEG_QUALITY, 92})) throw Error(path + ": cannot be written");
}

/// The picture without the frame's outer parts, where nothing changes.
cv::Mat middle_of(const cv::Mat& frame) {
  return frame({frame.cols / 4, frame.rows / 4, frame.cols / 2, frame.rows / 2});
}

cv::Mat row_of(const Image& whole, const Image& lights, const Image& rest, double gain) {
  cv::Mat row;
  cv::hconcat(std::vector<cv::Mat>{coded(whole, gain), coded(lights, gain), coded(rest, gain)}, row);
  return row;
}

/// What a sensor would tell: light adds up, however it is divided.
void report_sum(const Image& lights, const Image& rest, const Image& both) {
  double most = 0, sum = 0;
  for (std::size_t i = 0; i < both.data.size(); ++i) {
    const double apart = std::abs(std::min(lights.data[i] + rest.data[i], 1.0f) - std::min(both.data[i], 1.0f));
    most = std::max(most, apart);
    sum += apart;
  }
  std::printf("lights and rest against both, of sensor white: at most %.4f, mean %.6f\n", most,
              sum / static_cast<double>(both.data.size()));
}

void run(const std::string& location, const std::string& folder) {
  Studio studio(location);
  const SceneSettings::Quality& quality = studio.settings().quality;
  const render::Probe& whole = studio.built().probe;
  const render::SplitProbe split =
      render::split_lights(whole, {studio.built().scene.transfer.bands, quality.tolerance, quality.light_samples});
  const render::Probe lights = difference(whole, split.rest);
  cv::Mat probes;
  cv::vconcat(row_of(whole.image, lights.image, split.rest.image, kBrightProbe),
              row_of(whole.image, lights.image, split.rest.image, kDarkProbe), probes);
  write(folder + "/light_probe.jpg", {probes});

  const Image in_lights = studio.frame(lights_alone(studio, split)), in_rest = studio.frame(rest_alone(studio, split));
  const Image in_both = studio.frame({studio.built().scene, glm::dvec3(1)});
  report_sum(in_lights, in_rest, in_both);
  const cv::Mat both = coded(in_both, 1), truth = studio.truth();
  write(folder + "/light_parts.jpg", {middle_of(coded(in_lights, 1)), middle_of(coded(in_rest, 1)), middle_of(both)});
  cv::Mat difference;
  cv::absdiff(both, truth, difference);
  write(folder + "/light_truth.jpg", {middle_of(both), middle_of(truth), middle_of(difference * 8)});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: light_pictures RECORDING FOLDER\n");
    return 2;
  }
  try {
    run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
