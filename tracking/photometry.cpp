#include "tracking/photometry.hpp"

#include <algorithm>
#include <vector>

#include "tracking/families.hpp"
#include "tracking/ideal_pixels.hpp"
#include "tracking/lens.hpp"
#include "tracking/tag_pattern.hpp"
#include "tracking/tag_view.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kSmallestCellPx = 3;     ///< below it, no pixel of a cell is free of its neighbours' light
constexpr int kSamplesAcross = 8;         ///< of a cell's middle, at most: more would add nothing but time
constexpr double kClippedLinear = 0.955;  ///< code 250 of 255 in sRGB: at or above, the true value is unknown
constexpr double kClippedShare = 0.1;     ///< of the white samples: more would pull their mean
constexpr double kTrimmedShare = 0.25;    ///< of the cells, at either end: a highlight, a shadow's edge, a stain

/// Maps cells of the layout to where they are seen.
struct CellGrid {
  const CameraModel& camera;
  const RigidTransform& camera_from_tag;
  double cell_m;
  double half_size_m;

  std::optional<glm::dvec2> seen_px(double column, double row) const {
    const glm::dvec3 point_m(column * cell_m - half_size_m, half_size_m - row * cell_m, 0);
    return project_px(camera, camera_from_tag * point_m);
  }

  /// The shorter of the cell's two middle lines; 0 where it cannot be seen.
  double cell_px(int column, int row) const {
    const auto left = seen_px(column, row + 0.5), right = seen_px(column + 1, row + 0.5);
    const auto top = seen_px(column + 0.5, row), bottom = seen_px(column + 0.5, row + 1);
    if (!left || !right || !top || !bottom) return 0;
    return std::min(glm::distance(*left, *right), glm::distance(*top, *bottom));
  }
};

CellGrid cell_grid(const CameraModel& camera, const RigidTransform& camera_from_tag, const TagTarget& target,
                   const TagLayout& layout) {
  return {camera, camera_from_tag, target.size_m / layout.cells_across, target.size_m / 2};
}

struct CellMean {
  glm::dvec3 linear{0.0};
  int pixels = 0, clipped = 0;
};

/// Mean of the nearest pixels to a grid of points in the cell's central half.
CellMean cell_mean(const LinearPatch& patch, const CellGrid& grid, int column, int row) {
  CellMean mean;
  const double cell_px = grid.cell_px(column, row);
  if (cell_px < kSmallestCellPx) return mean;
  const int across = std::clamp(static_cast<int>(cell_px / 2), 1, kSamplesAcross);
  for (int i = 0; i < across * across; ++i) {
    const double u = 0.25 + 0.5 * (i % across + 0.5) / across, v = 0.25 + 0.5 * (i / across + 0.5) / across;
    const auto seen = grid.seen_px(column + u, row + v);
    if (!seen) continue;
    const double x = std::round(seen->x) - patch.rect.x, y = std::round(seen->y) - patch.rect.y;
    if (!(x >= 0 && x < patch.rect.width && y >= 0 && y < patch.rect.height)) continue;
    const float* rgb = &patch.rgb[3 * (static_cast<std::size_t>(y) * patch.rect.width + static_cast<std::size_t>(x))];
    mean.linear += glm::dvec3(rgb[0], rgb[1], rgb[2]);
    mean.clipped += std::max({rgb[0], rgb[1], rgb[2]}) >= kClippedLinear;
    ++mean.pixels;
  }
  if (mean.pixels > 0) mean.linear /= mean.pixels;
  return mean;
}

/// Mean over cells without the darkest and brightest quarter.
glm::dvec3 trimmed_mean(std::vector<CellMean> cells) {
  std::sort(cells.begin(), cells.end(), [](const CellMean& a, const CellMean& b) {
    return glm::dot(a.linear, kLuminanceWeights) < glm::dot(b.linear, kLuminanceWeights);
  });
  const auto trimmed = static_cast<std::size_t>(kTrimmedShare * static_cast<double>(cells.size()));
  glm::dvec3 sum(0.0);
  for (std::size_t i = trimmed; i < cells.size() - trimmed; ++i) sum += cells[i].linear;
  return sum / static_cast<double>(cells.size() - 2 * trimmed);
}

}  // namespace

PixelRect photometry_region(const CameraModel& camera, const RigidTransform& camera_from_tag, const TagTarget& target) {
  const TagLayout layout = tag_layout(target.family, target.id);
  const CellGrid grid = cell_grid(camera, camera_from_tag, target, layout);
  // A lens bends the outline, so its sides count, not only its corners.
  constexpr int kPointsPerSide = 8;
  glm::dvec2 low(1e9), high(-1e9);
  for (int i = 0; i <= kPointsPerSide; ++i) {
    const double at = -layout.margin + i * static_cast<double>(layout.side()) / kPointsPerSide;
    const double first = -layout.margin, last = layout.cells_across + layout.margin;
    for (const auto& point : {grid.seen_px(at, first), grid.seen_px(at, last), grid.seen_px(first, at), grid.seen_px(last, at)}) {
      if (!point || !std::isfinite(point->x + point->y)) return {};
      low = glm::min(low, *point);
      high = glm::max(high, *point);
    }
  }
  const glm::dvec2 image(camera.width_px, camera.height_px);
  const glm::ivec2 from(glm::clamp(glm::floor(low), glm::dvec2(0), image));
  const glm::ivec2 to(glm::clamp(glm::ceil(high) + 1.0, glm::dvec2(0), image));
  const PixelRect region{from.x, from.y, to.x - from.x, to.y - from.y};
  return region.empty() ? PixelRect{} : region;
}

namespace {

/// Least squares of every channel on the share of white, over the whole print.
std::optional<TagPhotometry> unmixed_photometry(const LinearPatch& patch, const CameraModel& camera,
                                                const RigidTransform& camera_from_tag, const TagTarget& target,
                                                const TagLayout& layout, const Covariance2& blur_px2) {
  constexpr double kLeastSpread = 0.02;  // variance of the share of white: less leaves nothing to tell them apart by
  const TagView view(camera, camera_from_tag, target.size_m, layout.cells_across);
  const TagPattern pattern(layout);
  TagPhotometry photometry;
  double n = 0, w = 0, ww = 0, clipped = 0, light = 0;
  glm::dvec3 l(0.0), wl(0.0);
  for (int row = 0; row < patch.rect.height; ++row)
    for (int column = 0; column < patch.rect.width; ++column) {
      const auto place = ideal_pixel(camera, {patch.rect.x + column, patch.rect.y + row});
      const auto point = place ? view.at(place->ideal_px) : std::nullopt;
      if (!point || point->cell.x < 0 || point->cell.y < 0) continue;
      if (point->cell.x > layout.cells_across || point->cell.y > layout.cells_across) continue;
      const PatternSample sample = pattern.sample(point->cell, in_cells(blur_px2, point->cell_per_px * place->ideal_per_seen));
      if (!sample.known) continue;
      const float* rgb = &patch.rgb[3 * (static_cast<std::size_t>(row) * patch.rect.width + static_cast<std::size_t>(column))];
      const glm::dvec3 linear(rgb[0], rgb[1], rgb[2]);
      light += sample.white > 0.5;
      clipped += sample.white > 0.5 && std::max({rgb[0], rgb[1], rgb[2]}) >= kClippedLinear;
      n += 1, w += sample.white, ww += sample.white * sample.white;
      l += linear, wl += sample.white * linear;
    }
  const double spread = n * ww - w * w;
  if (!(spread > kLeastSpread * n * n) || clipped > kClippedShare * light) return std::nullopt;
  const glm::dvec3 gain = (n * wl - w * l) / spread;
  photometry.black_linear = glm::max((l - gain * w) / n, glm::dvec3(0.0));
  photometry.white_linear = photometry.black_linear + gain;
  photometry.white_pixels = static_cast<int>(light);
  photometry.black_pixels = static_cast<int>(n - light);
  return glm::dot(gain, kLuminanceWeights) > 0 ? std::optional(photometry) : std::nullopt;
}

}  // namespace

std::optional<TagPhotometry> measure_photometry(const LinearPatch& patch, const CameraModel& camera,
                                                const RigidTransform& camera_from_tag, const TagTarget& target,
                                                const std::optional<Covariance2>& blur_px2) {
  const TagLayout layout = tag_layout(target.family, target.id);
  const CellGrid grid = cell_grid(camera, camera_from_tag, target, layout);
  std::vector<CellMean> white, black;
  TagPhotometry photometry;
  int clipped_white = 0;
  for (int row = -layout.margin; row < layout.cells_across + layout.margin; ++row)
    for (int column = -layout.margin; column < layout.cells_across + layout.margin; ++column) {
      const Ink ink = layout.at(column, row);
      if (ink == Ink::unknown) continue;
      const CellMean mean = cell_mean(patch, grid, column, row);
      if (mean.pixels == 0) continue;
      (ink == Ink::white ? white : black).push_back(mean);
      (ink == Ink::white ? photometry.white_pixels : photometry.black_pixels) += mean.pixels;
      if (ink == Ink::white) clipped_white += mean.clipped;
    }
  // Fewer than a ring's worth of either would let a single stain decide.
  constexpr std::size_t kFewestCells = 8;
  if (white.size() < kFewestCells || black.size() < kFewestCells)
    return blur_px2 ? unmixed_photometry(patch, camera, camera_from_tag, target, layout, *blur_px2) : std::nullopt;
  if (clipped_white > kClippedShare * photometry.white_pixels) return std::nullopt;
  photometry.white_linear = trimmed_mean(white);
  photometry.black_linear = trimmed_mean(black);
  if (!(glm::dot(photometry.white_linear - photometry.black_linear, kLuminanceWeights) > 0)) return std::nullopt;
  return photometry;
}

}  // namespace catchlight::tracking
