#include "tracking/refinement/ideal_pixels.hpp"

#include "catchlight/projection.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kTilePx = 16;

}  // namespace

std::optional<IdealPixel> ideal_pixel(const CameraModel& camera, const glm::dvec2& seen_px) {
  if (!camera.has_distortion()) return IdealPixel{seen_px};
  const auto ideal_px = undistort_px(camera, seen_px);
  if (!ideal_px) return std::nullopt;
  return IdealPixel{*ideal_px, glm::inverse(distortion_jacobian(camera, *ideal_px))};
}

IdealPixels::IdealPixels(const CameraModel& camera) : camera_(camera), tiles_across_((camera.width_px + kTilePx - 1) / kTilePx) {
  const int tiles_down = (camera.height_px + kTilePx - 1) / kTilePx;
  tiles_.resize(static_cast<std::size_t>(tiles_across_) * static_cast<std::size_t>(tiles_down));
}

std::optional<IdealPixel> IdealPixels::at(int x, int y) {
  if (!camera_.has_distortion()) return IdealPixel{glm::dvec2(x, y)};
  auto& tile = tiles_[static_cast<std::size_t>(y / kTilePx * tiles_across_ + x / kTilePx)];
  if (tile.empty())
    for (int row = 0; row < kTilePx; ++row)
      for (int column = 0; column < kTilePx; ++column)
        tile.push_back(ideal_pixel(camera_, {x / kTilePx * kTilePx + column, y / kTilePx * kTilePx + row}));
  return tile[static_cast<std::size_t>(y % kTilePx * kTilePx + x % kTilePx)];
}

}  // namespace catchlight::tracking
