#include "render/cpu/receiver/receiver_image.hpp"

#include <algorithm>
#include <vector>

#include "catchlight/util/parallel.hpp"
#include "render/camera/clip_from_camera.hpp"
#include "render/math/float4.hpp"

namespace catchlight::render {
namespace {

/// Pixels along a cell, which is interpolated between its corners where these differ by no more than kSmooth.
constexpr int kCell = 4;
constexpr float kSmooth = 0.01f;

/// The shadow that the camera sees.
class SeenShadow {
 public:
  SeenShadow(const FrameView& view, const PixelRays& pixel_rays, const ReceiverShadow& shadow)
      : pixel_rays_(pixel_rays),
        shadow_(shadow),
        eye_m_(inverse(view.camera_from_tag).translation_m),
        tag_from_camera_(glm::transpose(view.camera_from_tag.rotation)) {}

  Float4 at(int x, int y) const {
    const glm::vec3 direction = tag_from_camera_ * glm::vec3(pixel_rays_.at(x, y), 1.0f);
    const float depth_m = -eye_m_.z / direction.z;
    if (!(depth_m > static_cast<float>(kNear_m))) return splat(1);
    return float4(shadow_.ratio(glm::vec2(eye_m_) + depth_m * glm::vec2(direction)), 1);
  }

 private:
  const PixelRays& pixel_rays_;
  const ReceiverShadow& shadow_;
  glm::vec3 eye_m_;
  glm::mat3 tag_from_camera_;
};

bool are_alike(Float4 a, Float4 b, Float4 c, Float4 d) {
  for (int i = 0; i < 3; ++i) {
    const float low = std::min(std::min(a[i], b[i]), std::min(c[i], d[i])),
                high = std::max(std::max(a[i], b[i]), std::max(c[i], d[i]));
    if (!(high - low <= kSmooth)) return false;
  }
  return true;
}

/// The rows of cells below each other share their corners: a row of corners ends one and begins the next.
std::vector<Float4> corner_row(const SeenShadow& seen, const PixelRect& rect, int row) {
  std::vector<Float4> corners;
  for (int x = rect.x; x < rect.x + rect.width + kCell; x += kCell) corners.push_back(seen.at(x, rect.y + row * kCell));
  return corners;
}

}  // namespace

SharpBands draw_receiver(const FrameView& view, const FramePlan& plan, const PixelRays& pixel_rays, const ReceiverShadow& shadow,
                         Image& ratio) {
  std::ranges::fill(ratio.data, 1.0f);
  if (!plan.draws_receiver) return {};
  const Bounds reach{glm::vec3(shadow.reach().min_m, 0), glm::vec3(shadow.reach().max_m, 0)};
  const PixelRect rect =
      intersect(visible_rect(view.camera, plan.distortion_limit, view.camera_from_tag, reach, kNear_m), plan.virtual_rect);
  const SeenShadow seen(view, pixel_rays, shadow);
  const int rows = (rect.height + kCell - 1) / kCell, columns = (rect.width + kCell - 1) / kCell;
  std::vector<std::vector<Float4>> corners(static_cast<std::size_t>(rows) + 1);
  parallel_for(corners.size(), 0, [&](std::size_t row) { corners[row] = corner_row(seen, rect, static_cast<int>(row)); });
  SharpBands sharp(static_cast<std::size_t>(rows));
  const auto fill_cell = [&](int row, int column) {
    const auto above = &corners[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    const auto below = &corners[static_cast<std::size_t>(row) + 1][static_cast<std::size_t>(column)];
    const PixelRect cell = intersect({rect.x + column * kCell, rect.y + row * kCell, kCell, kCell}, rect);
    const bool alike = are_alike(above[0], above[1], below[0], below[1]);
    if (!alike) sharp[static_cast<std::size_t>(row)] = unite(sharp[static_cast<std::size_t>(row)], cell);
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      const float down = static_cast<float>(y - cell.y) / kCell;
      const Float4 left = blend(above[0], below[0], down), step = (blend(above[1], below[1], down) - left) * splat(1.0f / kCell);
      float* pixel = ratio.pixel(cell.x - plan.virtual_rect.x, y - plan.virtual_rect.y);
      for (int x = 0; x < cell.width; ++x, pixel += 4)
        store(alike ? left + splat(static_cast<float>(x)) * step : seen.at(cell.x + x, y), pixel);
    }
  };
  parallel_for(sharp.size(), 0, [&](std::size_t row) {
    for (int column = 0; column < columns; ++column) fill_cell(static_cast<int>(row), column);
  });
  std::erase_if(sharp, [](const PixelRect& band) { return band.empty(); });
  for (PixelRect& band : sharp) band.x -= plan.virtual_rect.x, band.y -= plan.virtual_rect.y;
  return sharp;
}

}  // namespace catchlight::render
