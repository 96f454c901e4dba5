#include "app/tools/replay/renderer_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <opencv2/core.hpp>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {

namespace {

/// The pixels' codes, 0 to 255, of a frame with its composite in it.
cv::Mat codes_of(const Frame& frame, const Composite& composite) {
  const Plate plate = frame.rgb({0, 0, frame.width_px(), frame.height_px()});
  const int depth = plate.format == Plate::Format::rgb_u8    ? CV_8UC3
                    : plate.format == Plate::Format::rgb_u16 ? CV_16UC3
                                                             : CV_32FC3;
  const double to_255 = depth == CV_8UC3 ? 1.0 : depth == CV_16UC3 ? 1.0 / 257 : 255.0;
  cv::Mat codes;
  cv::Mat(plate.rect.height, plate.rect.width, depth, const_cast<std::byte*>(plate.pixels.data()))
      .convertTo(codes, CV_32F, to_255);
  const PixelRect& rect = composite.rect;
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      const float* rgba = &composite.rgba[4 * (static_cast<std::size_t>(y) * rect.width + x)];
      if (rgba[3] != 0) codes.at<cv::Vec3f>(rect.y + y, rect.x + x) = cv::Vec3f(rgba[0], rgba[1], rgba[2]) * 255;
    }
  }
  return codes;
}

/// What is written ends at black and at white; a code that is none shows as black.
float shown(float code) {
  return code > 0 ? std::min(code, 255.0f) : 0;
}

std::string line(const char* figure, double value, double most, std::int64_t frame) {
  char text[160];
  std::snprintf(text, sizeof text, "cpu and gl differ in frame %lld: %s %.2f of 255, expected at most %.1f",
                static_cast<long long>(frame), figure, value, most);
  return text;
}

}  // namespace

CodeDifference code_difference(const Frame& plate, const Composite& one, const Composite& other) {
  const cv::Mat a = codes_of(plate, one), b = codes_of(plate, other);
  std::vector<float> largest;
  largest.reserve(a.total());
  double sum = 0;
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) {
      float most = 0;
      for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(shown(a.at<cv::Vec3f>(y, x)[c]) - shown(b.at<cv::Vec3f>(y, x)[c])));
      largest.push_back(most);
      sum += most;
    }
  }
  const auto percentile = largest.begin() + static_cast<std::ptrdiff_t>(largest.size() * 99 / 100);
  std::nth_element(largest.begin(), percentile, largest.end());
  return {sum / static_cast<double>(largest.size()), *percentile};
}

std::vector<std::string> drift(const RendererDifference& difference) {
  std::vector<std::string> lines;
  const auto& [mean, p99] = difference.worst;
  if (!(mean <= kMaxRendererDifference.mean))
    lines.push_back(line("mean", mean, kMaxRendererDifference.mean, difference.frame_of_mean));
  if (!(p99 <= kMaxRendererDifference.p99))
    lines.push_back(line("99th percentile", p99, kMaxRendererDifference.p99, difference.frame_of_p99));
  return lines;
}

RendererComparison::RendererComparison(SceneSettings settings, const CameraModel& camera, Log& log)
    : gl_((settings.renderer = Renderer::gl, std::move(settings)), camera, {}, log) {
  gl_.open_renderer();
}

void RendererComparison::compare(const FrameJob& drawn) {
  FrameJob job = drawn;
  gl_.render(job);
  const CodeDifference found = code_difference(drawn.image, drawn.result, job.result);
  ++difference_.frames;
  const auto keep = [&](double value, double& worst, std::int64_t& frame) {
    if (value > worst) worst = value, frame = drawn.image.number();
  };
  keep(found.mean, difference_.worst.mean, difference_.frame_of_mean);
  keep(found.p99, difference_.worst.p99, difference_.frame_of_p99);
}

}  // namespace catchlight::app
