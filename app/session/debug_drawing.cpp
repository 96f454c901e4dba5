#include "app/session/debug_drawing.hpp"

#include <cstdio>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "app/support/lettering.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/projection.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/util/enum_names.hpp"

namespace catchlight::app {
namespace {

const cv::Scalar kBlack(0, 0, 0), kWhite(255, 255, 255), kMagenta(255, 0, 255), kRed(255, 0, 0), kGreen(0, 255, 0),
    kBlue(0, 0, 255), kLightGreen(140, 255, 140), kOrange(255, 180, 60), kLightRed(255, 150, 150);
constexpr int kFractionBits = 8;  // bits of fraction in the coordinates that OpenCV draws lines between

struct Stroke {
  std::vector<glm::dvec2> points_px;
  cv::Scalar color;
};

struct Label {
  std::string text;
  cv::Scalar color;
  cv::Point baseline_px;
};

/// Everything to be drawn, in pixels of the frame.
struct Sketch {
  double unit_px;  ///< 1 in a picture of 480 lines
  std::vector<Stroke> strokes;
  double capital_px = 0;
  std::vector<Label> labels;

  int stroke_px() const { return std::max(1, static_cast<int>(std::lround(1.25 * unit_px))); }
  int halo_px() const { return stroke_px() + 2 * std::max(1, static_cast<int>(std::lround(unit_px))); }
};

/// The pixel at which the lens shows a point. Empty behind the camera, and beyond the field in which the lens model is one to
/// one: there it would fold back into the picture.
std::optional<glm::dvec2> seen_px(const CameraModel& camera, const glm::dvec3& point_camera_m) {
  const auto ideal_px = project_ideal_px(camera, point_camera_m);
  const auto px = project_px(camera, point_camera_m);
  if (!px || glm::length(*px) > 1e5) return std::nullopt;  // far beyond any picture
  const auto back_px = undistort_px(camera, *px);
  return back_px && glm::distance(*back_px, *ideal_px) < 0.01 ? px : std::nullopt;
}

/// Adds those pieces that can be seen of a straight line on or above the tag; the lens may bend it.
void add_line(Sketch& sketch, const CameraModel& camera, const RigidTransform& camera_from_tag, const glm::dvec3& from_m,
              const glm::dvec3& to_m, const cv::Scalar& color) {
  constexpr int kPieces = 16;
  Stroke stroke{{}, color};
  for (int i = 0; i <= kPieces; ++i) {
    const auto px = seen_px(camera, camera_from_tag * glm::mix(from_m, to_m, static_cast<double>(i) / kPieces));
    if (px) {
      stroke.points_px.push_back(*px);
      continue;
    }
    if (stroke.points_px.size() > 1) sketch.strokes.push_back(stroke);
    stroke.points_px.clear();
  }
  if (stroke.points_px.size() > 1) sketch.strokes.push_back(stroke);
}

void add_tag(Sketch& sketch, const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m) {
  const double half_m = tag_size_m / 2, arm_px = 5 * sketch.unit_px;
  const auto corners_m = tag_corners_m(tag_size_m);
  for (int i = 0; i < 4; ++i) add_line(sketch, camera, camera_from_tag, corners_m[i], corners_m[(i + 1) % 4], kWhite);
  const cv::Scalar axis_colors[] = {kRed, kGreen, kBlue};
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 end_m(0.0);
    end_m[axis] = half_m;
    add_line(sketch, camera, camera_from_tag, glm::dvec3(0.0), end_m, axis_colors[axis]);
  }
  for (const glm::dvec3& corner_m : corners_m) {
    const auto px = seen_px(camera, camera_from_tag * corner_m);
    if (!px) continue;
    for (const glm::dvec2& arm : {glm::dvec2(arm_px, 0), glm::dvec2(0, arm_px)})
      sketch.strokes.push_back({{*px - arm, *px + arm}, kMagenta});
  }
}

const cv::Scalar& color_of(TrackState state) {
  if (state == TrackState::lost) return kLightRed;
  return state == TrackState::tracking ? kLightGreen : kOrange;
}

/// Adds the labels in the top left corner, as wide as the picture at most.
void add_labels(Sketch& sketch, const TrackRow& row, int width_px) {
  sketch.labels.push_back({"frame " + std::to_string(row.frame) + "  " + name_of(row.state), color_of(row.state), {}});
  if (row.state == TrackState::tracking) {
    char text[80];
    std::snprintf(text, sizeof text, "corners +-%.3f px  residual %.1f codes  ambiguity %.2f", row.corner_sigma_px,
                  row.noise_codes, row.ambiguity);
    sketch.labels.push_back({text, kWhite, {}});
  }
  const int margin_px = static_cast<int>(std::lround(10 * sketch.unit_px));
  sketch.capital_px = std::max(11.5 * sketch.unit_px, 8.5);  // smaller letters cannot be read
  int widest_px = 1;
  for (const Label& label : sketch.labels)
    widest_px = std::max(widest_px, cvRound(sketch.capital_px * lettering_width(label.text)));
  sketch.capital_px *= std::min(1.0, static_cast<double>(width_px - 2 * margin_px) / widest_px);
  int y_px = margin_px;
  for (Label& label : sketch.labels) {
    y_px += static_cast<int>(std::lround(sketch.capital_px));
    label.baseline_px = {margin_px, y_px};
    y_px += static_cast<int>(std::lround(0.75 * sketch.capital_px));
  }
}

/// The rectangle around everything drawn, within the frame.
PixelRect bounds_of(const Sketch& sketch, const Frame& frame) {
  const int border_px = sketch.halo_px() + 1;
  PixelRect bounds;
  const auto add = [&](const glm::dvec2& px) {
    const glm::ivec2 corner = glm::ivec2(glm::floor(px)) - border_px;
    bounds = unite(bounds, {corner.x, corner.y, 2 * border_px + 2, 2 * border_px + 2});
  };
  for (const Stroke& stroke : sketch.strokes)
    for (const glm::dvec2& px : stroke.points_px) add(px);
  for (const Label& label : sketch.labels) {
    add({label.baseline_px.x, label.baseline_px.y - sketch.capital_px});
    add({label.baseline_px.x + sketch.capital_px * lettering_width(label.text),
         label.baseline_px.y + sketch.capital_px * kLetteringDescent});
  }
  return intersect(bounds, {0, 0, frame.width_px(), frame.height_px()});
}

/// Draws each thing first wider in black, so that it is seen on any background.
void draw(const Sketch& sketch, cv::Mat& canvas, const cv::Point& origin_px) {
  const auto fixed_point = [&](const glm::dvec2& px) {
    constexpr double kOne = 1 << kFractionBits;
    return cv::Point(cvRound((px.x - origin_px.x) * kOne), cvRound((px.y - origin_px.y) * kOne));
  };
  for (const bool halo : {true, false}) {
    const int thickness = halo ? sketch.halo_px() : sketch.stroke_px();
    for (const Stroke& stroke : sketch.strokes)
      for (std::size_t i = 1; i < stroke.points_px.size(); ++i)
        cv::line(canvas, fixed_point(stroke.points_px[i - 1]), fixed_point(stroke.points_px[i]), halo ? kBlack : stroke.color,
                 thickness, cv::LINE_AA, kFractionBits);
    for (const Label& label : sketch.labels)
      write_text(canvas, label.text, {label.baseline_px.x - origin_px.x, label.baseline_px.y - origin_px.y}, sketch.capital_px,
                 halo ? kBlack : label.color, thickness);
  }
}

/// Grows the composite to hold `bounds`; its new pixels leave the frame as it is.
void grow(Composite& composite, const PixelRect& bounds) {
  const PixelRect old = composite.rect, grown = unite(old, bounds);
  const auto width = static_cast<std::size_t>(grown.width);
  RawVector<float> rgba(4 * width * static_cast<std::size_t>(grown.height), 0.0f);
  for (int y = 0; y < old.height; ++y) {
    const auto from = composite.rgba.begin() + 4 * static_cast<std::ptrdiff_t>(y) * old.width;
    const auto to = static_cast<std::size_t>(old.y - grown.y + y) * width + static_cast<std::size_t>(old.x - grown.x);
    std::copy(from, from + 4 * static_cast<std::ptrdiff_t>(old.width), rgba.begin() + static_cast<std::ptrdiff_t>(4 * to));
  }
  composite.rect = grown;
  composite.rgba = std::move(rgba);
}

/// The composite's four floats of a pixel of the frame.
float* pixel(Composite& composite, int x, int y) {
  const auto index = static_cast<std::size_t>(y - composite.rect.y) * static_cast<std::size_t>(composite.rect.width) +
                     static_cast<std::size_t>(x - composite.rect.x);
  return composite.rgba.data() + 4 * index;
}

/// The frame in codes of 8 bits, RGB: fine enough for what antialiased edges are blended with.
cv::Mat plate_codes(const Frame& frame, const PixelRect& rect) {
  std::vector<unsigned char> codes = codes_8_bit(frame.rgb(rect));
  return cv::Mat(rect.height, rect.width, CV_8UC3, codes.data()).clone();
}

/// The codes that the frame shows with its composite.
cv::Mat shown_codes(const Frame& frame, Composite& composite, const PixelRect& rect) {
  cv::Mat codes = plate_codes(frame, rect);
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x) {
      const float* rgba = pixel(composite, rect.x + x, rect.y + y);
      if (rgba[3] > 0.5f)
        for (int c = 0; c < 3; ++c) codes.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(255 * rgba[c]);
    }
  return codes;
}

}  // namespace

void draw_debug(const Frame& frame, const TrackRow& row, const CameraModel& camera, double tag_size_m, Composite& composite) {
  Sketch sketch{std::min(frame.width_px(), frame.height_px()) / 480.0, {}, 0, {}};
  if (row.found) add_tag(sketch, camera, row.camera_from_tag, tag_size_m);
  add_labels(sketch, row, frame.width_px());

  const PixelRect rect = bounds_of(sketch, frame);
  grow(composite, rect);
  const cv::Mat shown = shown_codes(frame, composite, rect);
  cv::Mat canvas = shown.clone();
  draw(sketch, canvas, {rect.x, rect.y});
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x) {
      const cv::Vec3b& drawn = canvas.at<cv::Vec3b>(y, x);
      if (drawn == shown.at<cv::Vec3b>(y, x)) continue;
      float* rgba = pixel(composite, rect.x + x, rect.y + y);
      for (int c = 0; c < 3; ++c) rgba[c] = drawn[c] / 255.0f;
      rgba[3] = 1;
    }
}

}  // namespace catchlight::app
