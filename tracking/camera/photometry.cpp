#include "tracking/camera/photometry.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "catchlight/color.hpp"
#include "catchlight/projection.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/refinement/ideal_pixels.hpp"
#include "tracking/refinement/tag_pattern.hpp"
#include "tracking/refinement/tag_view.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kMinCellPx = 3;
constexpr int kSamplesAcross = 8;      ///< a cell's middle, at most: more would add nothing but time
constexpr double kClippedShare = 0.1;  ///< more clipped samples would pull their mean
constexpr double kTrimmedShare =
    0.25;  ///< share of the cells at either end that is left out: a highlight, a shadow's edge, a stain

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

/// The cell's central half; empty where it is too small to be free of its neighbours' light, or not wholly in the picture.
std::optional<SquareLight> cell_light(const PixelLight& light, const CellGrid& grid, int column, int row) {
  const double cell_px = grid.cell_px(column, row);
  if (cell_px < kMinCellPx) return std::nullopt;
  const PlaneSquare middle{{(column + 0.25) * grid.cell_m - grid.half_size_m, grid.half_size_m - (row + 0.75) * grid.cell_m},
                           grid.cell_m / 2};
  const int across = std::clamp(static_cast<int>(cell_px / 2), 1, kSamplesAcross);
  return square_light(light, grid.camera, grid.camera_from_tag, middle, across);
}

/// Mean over cells without the darkest and brightest quarter of a channel.
double trimmed_mean(const std::vector<SquareLight>& cells, int channel) {
  std::vector<double> light;
  for (const SquareLight& cell : cells) light.push_back(cell.mean[channel]);
  std::sort(light.begin(), light.end());
  const auto trimmed = static_cast<std::ptrdiff_t>(kTrimmedShare * static_cast<double>(cells.size()));
  return std::accumulate(light.begin() + trimmed, light.end() - trimmed, 0.0) /
         static_cast<double>(light.end() - light.begin() - 2 * trimmed);
}

/// Whether more cells are clipped than the mean leaves out at the bright end.
bool is_clipped(const std::vector<SquareLight>& cells, int channel) {
  const auto clipped = std::count_if(cells.begin(), cells.end(), [channel](const SquareLight& cell) {
    return cell.clipped[channel] > kClippedShare * cell.samples;
  });
  return clipped > static_cast<std::ptrdiff_t>(kTrimmedShare * static_cast<double>(cells.size()));
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
std::optional<TagPhotometry> unmixed_photometry(const PixelLight& light, const CameraModel& camera,
                                                const RigidTransform& camera_from_tag, const TagTarget& target,
                                                const TagLayout& layout, const Covariance2& blur_px2) {
  constexpr double kMinSpread = 0.02;  // variance of the share of white: less leaves nothing to tell them apart by
  const TagView view(camera, camera_from_tag, target.size_m, layout.cells_across);
  const TagPattern pattern(layout);
  TagPhotometry photometry;
  const PixelRect region = photometry_region(camera, camera_from_tag, target);
  double n = 0, w = 0, ww = 0, white = 0;
  glm::ivec3 clipped(0);
  glm::dvec3 l(0.0), wl(0.0);
  for (int y = region.y; y < region.y + region.height; ++y)
    for (int x = region.x; x < region.x + region.width; ++x) {
      const auto place = ideal_pixel(camera, {x, y});
      const auto point = place ? view.at(place->ideal_px) : std::nullopt;
      if (!point || point->cell.x < 0 || point->cell.y < 0) continue;
      if (point->cell.x > layout.cells_across || point->cell.y > layout.cells_across) continue;
      const PatternSample sample = pattern.sample(point->cell, in_cells(blur_px2, point->cell_per_px * place->ideal_per_seen));
      if (!sample.known) continue;
      const glm::dvec3 linear(light.at(x, y));
      white += sample.white > 0.5;
      for (int c = 0; c < 3; ++c) clipped[c] += sample.white > 0.5 && linear[c] >= light.clipping_linear[c];
      n += 1, w += sample.white, ww += sample.white * sample.white;
      l += linear, wl += sample.white * linear;
    }
  const double spread = n * ww - w * w;
  if (!(spread > kMinSpread * n * n)) return std::nullopt;
  const glm::dvec3 gain = (n * wl - w * l) / spread;
  photometry.black_linear = glm::max((l - gain * w) / n, glm::dvec3(0.0));
  photometry.white_linear = photometry.black_linear + gain;
  for (int c = 0; c < 3; ++c) {
    photometry.is_clipped[c] = clipped[c] > kClippedShare * white;
    if (photometry.is_clipped[c]) photometry.black_linear[c] = 0;
  }
  photometry.white_pixels = static_cast<int>(white);
  photometry.black_pixels = static_cast<int>(n - white);
  return glm::dot(gain, kLuminanceWeights) > 0 ? std::optional(photometry) : std::nullopt;
}

}  // namespace

std::optional<TagPhotometry> measure_photometry(const PixelLight& light, const CameraModel& camera,
                                                const RigidTransform& camera_from_tag, const TagTarget& target,
                                                const std::optional<Covariance2>& blur_px2) {
  const TagLayout layout = tag_layout(target.family, target.id);
  const CellGrid grid = cell_grid(camera, camera_from_tag, target, layout);
  std::vector<SquareLight> white, black;
  TagPhotometry photometry;
  for (int row = -layout.margin; row < layout.cells_across + layout.margin; ++row)
    for (int column = -layout.margin; column < layout.cells_across + layout.margin; ++column) {
      const Ink ink = layout.at(column, row);
      if (ink == Ink::unknown) continue;
      const auto cell = cell_light(light, grid, column, row);
      if (!cell) continue;
      (ink == Ink::white ? white : black).push_back(*cell);
      (ink == Ink::white ? photometry.white_pixels : photometry.black_pixels) += cell->samples;
    }
  // Fewer than a ring's worth of either would let a single stain decide.
  constexpr std::size_t kMinCells = 8;
  if (white.size() < kMinCells || black.size() < kMinCells)
    return blur_px2 ? unmixed_photometry(light, camera, camera_from_tag, target, layout, *blur_px2) : std::nullopt;
  for (int c = 0; c < 3; ++c) {
    photometry.white_linear[c] = trimmed_mean(white, c);
    photometry.black_linear[c] = trimmed_mean(black, c);
    photometry.is_clipped[c] = is_clipped(white, c);
  }
  if (!(glm::dot(photometry.white_linear - photometry.black_linear, kLuminanceWeights) > 0)) return std::nullopt;
  for (int c = 0; c < 3; ++c)
    if (is_clipped(black, c)) photometry.black_linear[c] = 0;
  return photometry;
}

}  // namespace catchlight::tracking
