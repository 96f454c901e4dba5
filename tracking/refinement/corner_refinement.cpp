#include "tracking/refinement/corner_refinement.hpp"

#include <opencv2/imgproc.hpp>
#include <optional>

#include "catchlight/projection.hpp"
#include "catchlight/response.hpp"
#include "tracking/refinement/edge_fit.hpp"

namespace catchlight::tracking {
namespace {

using LinearTable = std::array<double, 256>;

constexpr double kReachCells =
    0.7;  ///< how much of the uniform cell on either side is used; beyond it the blur of the next cell shows
constexpr double kReachPx = 6;            ///< enough for both plateaus at any blur that tags are decoded in
constexpr double kCornerClearancePx = 3;  ///< where the other edge's blur no longer shows
constexpr double kMaxShiftPx = 2;
constexpr double kSettledPx = 0.05;  ///< shifts below it would choose the same pixels again
constexpr int kMaxPasses = 3;
constexpr double kMaxColumns = 256;  ///< along an edge; more cost time and gain less than 0.003 px

LinearTable linear_table(const LumaView& luma) {
  LinearTable table;
  for (int code = 0; code < 256; ++code)
    table[code] = linear_from_code(luma.transfer, (code - luma.black_code) / (luma.white_code - luma.black_code));
  return table;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// The ends of the cells on either side of an edge: signed distances from it at its start and end, positive inside.
struct CellBand {
  double inside_start_px, inside_end_px, outside_start_px, outside_end_px;

  /// Whether a pixel sees nothing but the two cells that the edge separates.
  bool contains(double along, double across_px) const {
    const double inside_px = inside_start_px + (inside_end_px - inside_start_px) * along;
    const double outside_px = outside_start_px + (outside_end_px - outside_start_px) * along;
    return across_px <= std::min(kReachPx, kReachCells * inside_px) && across_px >= std::max(-kReachPx, kReachCells * outside_px);
  }
};

/// An edge in ideal pixels, with the tag's inside at positive distances.
struct Edge {
  glm::dvec2 start, direction, normal;
  double length_px;

  double along(const glm::dvec2& ideal_px) const { return glm::dot(ideal_px - start, direction) / length_px; }
  double across(const glm::dvec2& ideal_px) const { return glm::dot(ideal_px - start, normal); }
};

Edge edge_of(const Quad& ideal, int i) {
  const glm::dvec2 a = ideal[i], b = ideal[(i + 1) % 4], opposite = ideal[(i + 2) % 4];
  const double length_px = glm::length(b - a);
  const glm::dvec2 direction = (b - a) / length_px;
  glm::dvec2 normal(-direction.y, direction.x);
  if (glm::dot(opposite - a, normal) < 0) normal = -normal;
  return {a, direction, normal, length_px};
}

/// The cells' far sides are straight lines too, so their distance from the edge is linear along it.
CellBand cell_band(const Quad& ideal, int i, int cells_across) {
  const std::array<cv::Point2f, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  std::array<cv::Point2f, 4> seen;
  for (int k = 0; k < 4; ++k) seen[k] = cv::Point2f(static_cast<float>(ideal[k].x), static_cast<float>(ideal[k].y));
  const cv::Matx33d seen_from_square = cv::getPerspectiveTransform(square.data(), seen.data());
  const Edge edge = edge_of(ideal, i);
  const auto line_distance = [&](double inset, double at) {
    // Two points of the line `inset` inside side i of the unit square, turned to that side.
    const auto point = [&](double t) {
      const std::array<cv::Vec3d, 4> on_side{{{t, inset, 1}, {1 - inset, t, 1}, {1 - t, 1 - inset, 1}, {inset, 1 - t, 1}}};
      const cv::Vec3d h = seen_from_square * on_side[i];
      return glm::dvec2(h[0] / h[2], h[1] / h[2]);
    };
    const glm::dvec2 a = point(0), b = point(1);
    const double ta = edge.along(a), tb = edge.along(b);
    return edge.across(a) + (edge.across(b) - edge.across(a)) * (at - ta) / (tb - ta);
  };
  const double cell = 1.0 / cells_across;
  return {line_distance(cell, 0), line_distance(cell, 1), line_distance(-cell, 0), line_distance(-cell, 1)};
}

/// Collects the pixels beside one edge.
class EdgeSampler {
 public:
  EdgeSampler(const LumaView& luma, const LinearTable& linear, const CameraModel& camera, const Edge& edge, const CellBand& band)
      : luma_(luma), linear_(linear), camera_(camera), edge_(edge), band_(band) {
    const glm::dvec2 chord = seen_px(1) - seen_px(0);
    steep_ = std::abs(chord.y) > std::abs(chord.x);
    span_px_ = std::abs(chord[steep_]);
    stride_ = std::max(1, static_cast<int>(std::ceil(span_px_ / kMaxColumns)));
  }

  /// Walks along the edge as seen, in pieces short enough that the lens bends none of them.
  std::vector<EdgePixel> collect() {
    const int pieces = std::max(1, static_cast<int>(span_px_ / 16));
    for (int i = 0; i < pieces; ++i)
      add_piece(seen_px(static_cast<double>(i) / pieces), seen_px(static_cast<double>(i + 1) / pieces));
    return std::move(pixels_);
  }

 private:
  glm::dvec2 seen_px(double along) const {
    return distort_px(camera_, edge_.start + edge_.direction * (along * edge_.length_px));
  }

  /// One column after the other, or one row after the other along a steep edge.
  void add_piece(glm::dvec2 from, glm::dvec2 to) {
    const int major = steep_, minor = 1 - steep_;
    const int limits[2] = {luma_.width_px, luma_.height_px};
    if (from[major] > to[major]) std::swap(from, to);
    const int first = std::max(0, static_cast<int>(std::ceil(from[major])));
    const int last = std::min(limits[major], static_cast<int>(std::ceil(to[major])));
    for (int m = first; m < last; ++m) {
      if (m % stride_ != 0) continue;
      constexpr double kReachInColumnPx = 1.5 * kReachPx;  // 6 px across an edge at 45 degrees are 8.5 px of one column
      const double center = from[minor] + (to[minor] - from[minor]) * (m - from[major]) / (to[major] - from[major]);
      const int n_first = std::max(0, static_cast<int>(std::ceil(center - kReachInColumnPx)));
      const int n_last = std::min(limits[minor] - 1, static_cast<int>(std::floor(center + kReachInColumnPx)));
      for (int n = n_first; n <= n_last; ++n) steep_ ? add_pixel(n, m) : add_pixel(m, n);
    }
  }

  void add_pixel(int x, int y) {
    const auto ideal_px = undistort_px(camera_, {x, y});
    if (!ideal_px) return;
    const double along = edge_.along(*ideal_px), across_px = edge_.across(*ideal_px);
    const double clearance = std::clamp(kCornerClearancePx / edge_.length_px, 0.0, 0.25);
    if (along < clearance || along > 1 - clearance || !band_.contains(along, across_px)) return;
    pixels_.push_back({along, across_px, linear_[luma_.data[static_cast<std::ptrdiff_t>(y) * luma_.stride + x]]});
  }

  const LumaView& luma_;
  const LinearTable& linear_;
  const CameraModel& camera_;
  const Edge& edge_;
  const CellBand& band_;
  bool steep_ = false;
  double span_px_ = 0;
  int stride_ = 1;
  std::vector<EdgePixel> pixels_;
};

struct Line {
  glm::dvec2 point, direction;
};

/// Empty as well for an edge of the wrong polarity or too far away: that of something else.
std::optional<EdgeFit> plausible_fit(std::span<const EdgePixel> pixels, bool white_inside) {
  const auto fit = fit_edge(pixels);
  if (!fit || (fit->step > 0) != white_inside) return std::nullopt;
  if (std::max(std::abs(fit->shift_start_px), std::abs(fit->shift_end_px)) > kMaxShiftPx) return std::nullopt;
  return fit;
}

std::optional<glm::dvec2> intersection(const Line& a, const Line& b) {
  const double sine = cross(a.direction, b.direction);
  if (std::abs(sine) < 1e-6) return std::nullopt;
  return a.point + a.direction * (cross(b.point - a.point, b.direction) / sine);
}

}  // namespace

RefinedCorners refine_corners(const LumaView& luma, const CameraModel& camera, const Quad& corners_px, const TagLayout& layout) {
  RefinedCorners refined{corners_px, {}, {}};
  Quad ideal;
  for (int i = 0; i < 4; ++i) {
    const auto corner = undistort_px(camera, corners_px[i]);
    if (!corner) return refined;
    ideal[i] = *corner;
  }
  const LinearTable linear = linear_table(luma);
  double shift_px = kMaxShiftPx;
  for (int pass = 0; pass < kMaxPasses && shift_px > kSettledPx; ++pass) {
    shift_px = 0;
    std::array<Line, 4> lines;
    for (int i = 0; i < 4; ++i) {
      const Edge edge = edge_of(ideal, i);
      const CellBand band = cell_band(ideal, i, layout.cells_across);
      const auto fit = plausible_fit(EdgeSampler(luma, linear, camera, edge, band).collect(), layout.white_inside);
      refined.edge_refined[i] = fit.has_value();
      const EdgeFit found = fit.value_or(EdgeFit{});  // no shift where there is none
      refined.edge_blur_px[i] = found.blur_px;
      const glm::dvec2 start = edge.start + edge.normal * found.shift_start_px;
      lines[i] = {start, ideal[(i + 1) % 4] + edge.normal * found.shift_end_px - start};
      shift_px = std::max({shift_px, std::abs(found.shift_start_px), std::abs(found.shift_end_px)});
    }
    for (int i = 0; i < 4; ++i)
      if (const auto corner = intersection(lines[(i + 3) % 4], lines[i])) ideal[i] = *corner;
  }
  for (int i = 0; i < 4; ++i) refined.corners_px[i] = distort_px(camera, ideal[i]);
  return refined;
}

}  // namespace catchlight::tracking
