#include "app/session/debug_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "app/session/track_sketch.hpp"
#include "app/support/lettering.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {
namespace {

constexpr Rgb kBlack{0, 0, 0};
constexpr int kFractionBits = 8;  // bits of fraction in the coordinates that OpenCV draws lines between

cv::Scalar scalar(const Rgb& color) {
  return {double(color[0]), double(color[1]), double(color[2])};
}

struct Label {
  std::string text;
  Rgb color;
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

void add(Sketch& sketch, std::vector<Stroke> strokes) {
  std::ranges::move(strokes, std::back_inserter(sketch.strokes));
}

void add_tag(Sketch& sketch, const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m) {
  add(sketch, outline_strokes(camera, camera_from_tag, tag_size_m));
  add(sketch, axis_strokes(camera, camera_from_tag, tag_size_m));
  add(sketch, corner_strokes(camera, camera_from_tag, tag_size_m, 5 * sketch.unit_px));
}

/// Adds the labels in the top left corner, as wide as the picture at most.
void add_labels(Sketch& sketch, const TrackRow& row, int width_px) {
  for (SketchLine& line : state_lines(row)) sketch.labels.push_back({std::move(line.text), line.color, {}});
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
        cv::line(canvas, fixed_point(stroke.points_px[i - 1]), fixed_point(stroke.points_px[i]),
                 scalar(halo ? kBlack : stroke.color), thickness, cv::LINE_AA, kFractionBits);
    for (const Label& label : sketch.labels)
      write_text(canvas, label.text, {label.baseline_px.x - origin_px.x, label.baseline_px.y - origin_px.y}, sketch.capital_px,
                 scalar(halo ? kBlack : label.color), thickness);
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
