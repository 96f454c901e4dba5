#include "render/cpu/receiver_image.hpp"

#include <algorithm>
#include <vector>

#include "catchlight/util/parallel.hpp"
#include "render/camera/clip_from_camera.hpp"

namespace catchlight::render {
namespace {

constexpr int kRowsAtOnce = 8;

}  // namespace

PixelRect draw_receiver(const FrameView& view, const FramePlan& plan, const PixelRays& pixel_rays, const ReceiverShadow& shadow,
                        Image& ratio) {
  std::ranges::fill(ratio.data, 1.0f);
  if (!plan.draws_receiver) return {};
  const Bounds reach{glm::vec3(shadow.reach().min_m, 0), glm::vec3(shadow.reach().max_m, 0)};
  const PixelRect seen =
      intersect(visible_rect(view.camera, plan.distortion_limit, view.camera_from_tag, reach, kNear_m), plan.virtual_rect);
  std::vector<PixelRect> changed(static_cast<std::size_t>((seen.height + kRowsAtOnce - 1) / kRowsAtOnce));
  const glm::vec3 eye_m(inverse(view.camera_from_tag).translation_m);
  const glm::mat3 tag_from_camera(glm::transpose(view.camera_from_tag.rotation));
  parallel_for(changed.size(), 0, [&](std::size_t band) {
    const int first = seen.y + static_cast<int>(band) * kRowsAtOnce;
    for (int y = first; y < std::min(first + kRowsAtOnce, seen.y + seen.height); ++y) {
      int left = seen.x + seen.width, right = seen.x - 1;
      float* pixel = ratio.pixel(seen.x - plan.virtual_rect.x, y - plan.virtual_rect.y);
      for (int x = seen.x; x < seen.x + seen.width; ++x, pixel += 4) {
        const glm::vec3 direction = tag_from_camera * glm::vec3(pixel_rays.at(x, y), 1.0f);
        const float depth_m = -eye_m.z / direction.z;
        if (!(depth_m > static_cast<float>(kNear_m))) continue;
        const glm::vec3 value = shadow.ratio(glm::vec2(eye_m) + depth_m * glm::vec2(direction));
        if (value == glm::vec3(1)) continue;
        pixel[0] = value.x, pixel[1] = value.y, pixel[2] = value.z;
        left = std::min(left, x), right = std::max(right, x);
      }
      if (left <= right) changed[band] = unite(changed[band], {left, y, right - left + 1, 1});
    }
  });
  PixelRect all;
  for (const PixelRect& each : changed) all = unite(all, each);
  return {all.x - plan.virtual_rect.x, all.y - plan.virtual_rect.y, all.width, all.height};
}

}  // namespace catchlight::render
