#include "tracking/corner_refinement.hpp"

#include <opencv2/imgproc.hpp>
#include <optional>

#include "tracking/edge_fit.hpp"
#include "tracking/lens.hpp"

namespace catchlight::tracking {
namespace {

using Quad = std::array<glm::dvec2, 4>;
using LinearTable = std::array<double, 256>;

constexpr double kReachCells = 0.7;       ///< of the uniform cell on either side; beyond it the blur of the next cell shows
constexpr double kReachPx = 6;            ///< enough for both plateaus at any blur that tags are decoded in
constexpr double kCornerClearancePx = 3;  ///< where the other edge's blur no longer shows
constexpr double kLargestShiftPx = 2;
constexpr int kPasses = 3;

LinearTable linear_table(const LumaView& luma) {
  LinearTable table;
  for (int code = 0; code < 256; ++code)
    table[code] = linear_from_code(luma.transfer, (code - luma.black_code) / (luma.white_code - luma.black_code));
  return table;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Where the cells on either side of an edge end: signed distances from it at its start and end, positive inside.
struct CellBand {
  double inside_start_px, inside_end_px, outside_start_px, outside_end_px;
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

/// The pixels beside the edge that see nothing but the two cells it separates.
std::vector<EdgePixel> edge_pixels(const LumaView& luma, const LinearTable& linear, const CameraModel& camera, const Edge& edge,
                                   const CellBand& band) {
  std::vector<EdgePixel> pixels;
  const double clearance = std::clamp(kCornerClearancePx / edge.length_px, 0.0, 0.25);
  // Walk along the edge in pieces short enough that the lens bends none of them, each with its own pixel rows or columns.
  const auto seen = [&](double t) { return distort_px(camera, edge.start + edge.direction * (t * edge.length_px)); };
  const glm::dvec2 chord = seen(1) - seen(0);
  const int major = std::abs(chord.x) >= std::abs(chord.y) ? 0 : 1, minor = 1 - major;
  const int limits[2] = {luma.width_px, luma.height_px};
  const double reach_rows = 1.5 * kReachPx;  // 6 px across an edge at 45 degrees are 8.5 px of one row
  const int pieces = std::max(1, static_cast<int>(std::abs(chord[major]) / 16));
  for (int piece = 0; piece < pieces; ++piece) {
    glm::dvec2 from = seen(static_cast<double>(piece) / pieces), to = seen(static_cast<double>(piece + 1) / pieces);
    if (from[major] > to[major]) std::swap(from, to);
    const int first = std::max(0, static_cast<int>(std::ceil(from[major])));
    const int last = std::min(limits[major], static_cast<int>(std::ceil(to[major])));
    for (int m = first; m < last; ++m) {
      const double center = from[minor] + (to[minor] - from[minor]) * (m - from[major]) / (to[major] - from[major]);
      const int n_first = std::max(0, static_cast<int>(std::ceil(center - reach_rows)));
      const int n_last = std::min(limits[minor] - 1, static_cast<int>(std::floor(center + reach_rows)));
      for (int n = n_first; n <= n_last; ++n) {
        const int x = major == 0 ? m : n, y = major == 0 ? n : m;
        const auto ideal = undistort_px(camera, {x, y});
        if (!ideal) continue;
        const double along = edge.along(*ideal), across = edge.across(*ideal);
        if (along < clearance || along > 1 - clearance || std::abs(across) > kReachPx) continue;
        const double inside_px = band.inside_start_px + (band.inside_end_px - band.inside_start_px) * along;
        const double outside_px = band.outside_start_px + (band.outside_end_px - band.outside_start_px) * along;
        if (across > kReachCells * inside_px || across < kReachCells * outside_px) continue;
        pixels.push_back({along, across, linear[luma.data[static_cast<std::ptrdiff_t>(y) * luma.stride + x]]});
      }
    }
  }
  return pixels;
}

struct Line {
  glm::dvec2 point, direction;
};

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
  for (int pass = 0; pass < kPasses; ++pass) {
    std::array<Line, 4> lines;
    for (int i = 0; i < 4; ++i) {
      const Edge edge = edge_of(ideal, i);
      const auto fit = fit_edge(edge_pixels(luma, linear, camera, edge, cell_band(ideal, i, layout.cells_across)));
      const bool plausible = fit && (fit->step > 0) == layout.white_inside &&
                             std::max(std::abs(fit->shift_start_px), std::abs(fit->shift_end_px)) < kLargestShiftPx;
      refined.edge_refined[i] = plausible;
      const glm::dvec2 start = edge.start + edge.normal * (plausible ? fit->shift_start_px : 0.0);
      const glm::dvec2 end = ideal[(i + 1) % 4] + edge.normal * (plausible ? fit->shift_end_px : 0.0);
      lines[i] = {start, end - start};
      refined.edge_blur_px[i] = plausible ? fit->blur_px : 0;
    }
    for (int i = 0; i < 4; ++i)
      if (const auto corner = intersection(lines[(i + 3) % 4], lines[i])) ideal[i] = *corner;
  }
  for (int i = 0; i < 4; ++i) refined.corners_px[i] = distort_px(camera, ideal[i]);
  return refined;
}

}  // namespace catchlight::tracking
