#include "app/tools/probe_view/probe_preview.hpp"

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "app/support/lettering.hpp"
#include "app/tools/probe_view/probe_statistics.hpp"
#include "catchlight/color.hpp"
#include "catchlight/util/parallel.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kCaptionPx = 30, kCapitalPx = 10;
const cv::Scalar kInk(255, 255, 255), kShade(0, 0, 0), kMark(60, 200, 255), kPaper(40, 40, 40);

class Painter {
 public:
  Painter(const render::Probe& probe, double yaw_deg, double ev)
      : probe_(probe), statistics_(measure_probe(probe, 1)), tag_from_probe_(render::tag_from_probe(render::UpAxis::z, yaw_deg)) {
    constexpr double kMidGrey = 0.18;
    exposure_ = statistics_.log_average > 0 ? kMidGrey / statistics_.log_average * std::exp2(ev) : 1;
    light_ = render::project_to_sh(probe, 3);
  }

  const ProbeStatistics& statistics() const { return statistics_; }
  glm::dvec3 probe_from_tag(const glm::dvec3& direction) const { return glm::transpose(tag_from_probe_) * direction; }

  glm::dvec3 radiance(const glm::dvec3& direction_probe) const { return glm::dvec3(render::sample(probe_, direction_probe)); }

  /// A grey matte surface (Ramamoorthi & Hanrahan 2001).
  glm::dvec3 matte(const glm::dvec3& normal_probe) const {
    constexpr double kAlbedo = 0.5, kCosine[3] = {1, 2.0 / 3, 1.0 / 4};
    double basis[9];
    render::evaluate_sh(normal_probe, 3, basis);
    glm::dvec3 sum(0);
    for (int l = 0; l < 3; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i)
        sum += kCosine[l] * basis[i] * glm::dvec3(light_[static_cast<std::size_t>(i)]);
    return kAlbedo * glm::max(sum, 0.0);
  }

  cv::Vec3b shown(const glm::dvec3& linear) const {
    const glm::dvec3 exposed = exposure_ * linear;
    const double luminance = glm::dot(kLuminanceWeights, exposed);
    cv::Vec3b code;
    for (int c = 0; c < 3; ++c)
      code[2 - c] =
          static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(std::min(1.0, 1.25 * exposed[c] / (1 + luminance)))));
    return code;
  }

 private:
  const render::Probe& probe_;
  ProbeStatistics statistics_;
  glm::dmat3 tag_from_probe_;
  double exposure_ = 1;
  render::ShRgb light_;
};

/// light(right, up), both in [-1, 1], for each pixel; empty shows the paper.
template <class Light>
cv::Mat painted(const Painter& painter, const cv::Size& size, const Light& light) {
  constexpr int kAcross = 2;
  cv::Mat picture(size, CV_8UC3, kPaper);
  parallel_for(size.height, 0, [&](std::size_t row) {
    for (int x = 0; x < size.width; ++x) {
      glm::dvec3 sum(0);
      int count = 0;
      for (int i = 0; i < kAcross * kAcross; ++i) {
        const double right = 2 * (x + (i % kAcross + 0.5) / kAcross) / size.width - 1;
        const double up = 1 - 2 * (static_cast<double>(row) + (i / kAcross + 0.5) / kAcross) / size.height;
        const std::optional<glm::dvec3> value = light(right, up);
        if (!value) continue;
        sum += *value;
        ++count;
      }
      if (count > 0) picture.at<cv::Vec3b>(static_cast<int>(row), x) = painter.shown(sum / static_cast<double>(count));
    }
  });
  return picture;
}

void write(cv::Mat& picture, const std::string& text, const cv::Point& at, const cv::Scalar& color = kInk) {
  for (const auto& [ink, thickness] : {std::pair(kShade, 3), std::pair(color, 1)})
    write_text(picture, text, {at.x, at.y}, kCapitalPx, ink, thickness);
}

/// A small cross with its text, kept inside the picture.
void mark(cv::Mat& picture, const glm::dvec2& at, const std::string& text, const cv::Scalar& color = kInk) {
  constexpr int kArmPx = 7, kTextPx = 9;
  const cv::Point centre(cvRound(at.x), cvRound(at.y));
  for (const auto& [ink, thickness] : {std::pair(kShade, 3), std::pair(color, 1)}) {
    cv::line(picture, centre - cv::Point(kArmPx, 0), centre + cv::Point(kArmPx, 0), ink, thickness, cv::LINE_AA);
    cv::line(picture, centre - cv::Point(0, kArmPx), centre + cv::Point(0, kArmPx), ink, thickness, cv::LINE_AA);
  }
  const int width = cvRound(kCapitalPx * lettering_width(text));
  const int x = std::clamp(centre.x - width / 2, 3, std::max(3, picture.cols - width - 3));
  const int y = centre.y + 2 * kTextPx + kArmPx < picture.rows ? centre.y + kTextPx + 2 * kArmPx : centre.y - kTextPx;
  write(picture, text, {x, y}, color);
}

cv::Mat panorama(const Painter& painter, int width) {
  const int height = width / 2;
  const auto at = [&](const glm::dvec3& direction_probe) {
    return render::texel_from_direction(render::ProbeLayout::latlong, width, height, direction_probe);
  };
  cv::Mat picture = painted(painter, {width, height}, [&](double right, double up) {
    const double longitude = -kPi * right, latitude = kPi / 2 * up;
    return std::optional(painter.radiance(
        {std::sin(longitude) * std::cos(latitude), std::sin(latitude), std::cos(longitude) * std::cos(latitude)}));
  });
  cv::line(picture, {0, height / 2}, {width, height / 2}, kShade, 1);
  const struct {
    glm::dvec3 tag;
    const char* name;
  } kDirections[] = {{{1, 0, 0}, "tag +x, right"},
                     {{-1, 0, 0}, "tag -x, left"},
                     {{0, 1, 0}, "tag +y, far side"},
                     {{0, -1, 0}, "tag -y, near side"},
                     {{0, 0, 1}, "up"},
                     {{0, 0, -1}, "down"}};
  for (const auto& direction : kDirections) mark(picture, at(painter.probe_from_tag(direction.tag)), direction.name);
  if (painter.statistics().max > 0) {
    const glm::dvec2 brightest = at(painter.statistics().brightest);
    cv::circle(picture, {cvRound(brightest.x), cvRound(brightest.y)}, 14, kMark, 2, cv::LINE_AA);
    mark(picture, brightest, "brightest: " + fixed_text(painter.statistics().max, 1), kMark);
  }
  return picture;
}

/// A ball seen by a far camera at tag -y: right is tag +x, up is tag +z. light(normal, tag frame).
template <class Light>
cv::Mat ball(const Painter& painter, int side, const Light& light) {
  constexpr double kMargin = 1.06;
  return painted(painter, {side, side}, [&](double right, double up) -> std::optional<glm::dvec3> {
    const double x = kMargin * right, z = kMargin * up, depth = 1 - x * x - z * z;
    if (depth < 0) return std::nullopt;
    return light(glm::dvec3(x, -std::sqrt(depth), z));
  });
}

cv::Mat plan(const Painter& painter, int side) {
  constexpr double kMargin = 1.06;
  cv::Mat picture = painted(painter, {side, side}, [&](double right, double up) -> std::optional<glm::dvec3> {
    const double radius = kMargin * std::hypot(right, up);
    if (radius > 1) return std::nullopt;
    const double angle = kPi / 2 * radius, scale = radius > 0 ? kMargin * std::sin(angle) / radius : 0;
    return painter.radiance(painter.probe_from_tag({scale * right, scale * up, std::cos(angle)}));
  });
  const int middle = side / 2, half = side / 16;
  cv::rectangle(picture, {middle - half, middle - half}, {middle + half, middle + half}, kInk, 2, cv::LINE_AA);
  cv::arrowedLine(picture, {middle, middle}, {middle + 2 * half, middle}, kInk, 2, cv::LINE_AA);
  cv::arrowedLine(picture, {middle, middle}, {middle, middle - 2 * half}, kInk, 2, cv::LINE_AA);
  write(picture, "x", {middle + 2 * half + 4, middle + 5});
  write(picture, "y", {middle - 5, middle - 2 * half - 6});
  return picture;
}

cv::Mat captioned(const cv::Mat& picture, const std::string& caption) {
  cv::Mat framed;
  cv::copyMakeBorder(picture, framed, 0, kCaptionPx, 0, 0, cv::BORDER_CONSTANT, kPaper);
  write(framed, caption, {6, framed.rows - 10});
  return framed;
}

}  // namespace

cv::Mat probe_preview(const render::Probe& probe, double yaw_deg, double ev, int width_px) {
  const Painter painter(probe, yaw_deg, ev);
  const int side = width_px / 3;
  const cv::Mat mirror = ball(painter, side, [&](const glm::dvec3& normal) {
    return painter.radiance(painter.probe_from_tag(glm::reflect(glm::dvec3(0, 1, 0), normal)));
  });
  const cv::Mat matte =
      ball(painter, side, [&](const glm::dvec3& normal) { return painter.matte(painter.probe_from_tag(normal)); });
  cv::Mat balls, picture;
  cv::hconcat(
      std::vector<cv::Mat>{captioned(mirror, "mirror ball, seen from tag -y"), captioned(matte, "matte ball, seen from tag -y"),
                           captioned(plan(painter, side), "from above: the light around the tag")},
      balls);
  cv::vconcat(captioned(panorama(painter, 3 * side), "all around, as seen from the tag; crosses mark where its axes point"),
              balls, picture);
  return picture;
}

}  // namespace catchlight::app
