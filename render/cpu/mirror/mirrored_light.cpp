#include "render/cpu/mirror/mirrored_light.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/util/parallel.hpp"
#include "shaders/shading.h"

namespace catchlight::render {
namespace {

/// A polished surface's lobe is as wide as the pixel's footprint: so many rays smooth what it shows.
constexpr int kPolishedRays = 4;
constexpr std::size_t kPointsAtOnce = 256;
/// So many neighbours, a square of them, look for the object along different rays of a rough lobe.
constexpr int kLookersAcross = 4, kLookers = kLookersAcross * kLookersAcross;

/// Neighbours share rays where their mirror directions differ by less than so many alphas, and they lie as deep to this share.
/// Two take half of a lobe each, whose patterns would show side by side: they share farther.
constexpr float kSharedTurn = 1, kSharedTurnOf2 = 3, kSharedDepth = 0.04f;
/// A pixel's footprint in shares of alpha, up to which 8, 4 and 2 pixels share a lobe's rays; beyond, neighbours see other
/// things.
constexpr float kFootprintOf8 = 0.25f, kFootprintOf4 = 0.5f, kFootprintOf2 = 2.25f;
/// How much what neighbours find counts, so that each ray of a lobe has the same say wherever its 8, 4 or 2 sharers lie.
constexpr float kSaysOf8[3][5] = {{1, 2, 2, 2, 1}, {2, 4, 4, 4, 2}, {1, 2, 2, 2, 1}};
constexpr float kSaysOf4[3][5] = {{0, 1, 2, 1, 0}, {0, 2, 4, 2, 0}, {0, 1, 2, 1, 0}};
constexpr float kSaysOf2[3][5] = {{0, 0, 1, 0, 0}, {0, 1, 4, 1, 0}, {0, 0, 1, 0, 0}};
/// The alpha of a lobe that is wide.
constexpr float kWideLobe = 0.2f;
/// Beyond this change from pixel to pixel, the neighbour is another surface.
constexpr float kMaxFootprint = 0.5f;

template <typename Work>
void for_chunks(std::size_t count, const Work& work) {
  parallel_for((count + kPointsAtOnce - 1) / kPointsAtOnce, 0,
               [&](std::size_t chunk) { work(chunk * kPointsAtOnce, std::min((chunk + 1) * kPointsAtOnce, count)); });
}

}  // namespace

MirroredLight::MirroredLight(const SurfaceMaterials& materials, const MirrorRays& rays, int lobe_rays)
    : materials_(materials),
      rays_(rays),
      lobe_rays_(lobe_rays),
      polished_points_(LobePoints::dealt(kPolishedRays, 1, 0)),
      single_point_(LobePoints::dealt(1, 1, 0)) {
  for (const int sharers : {1, 2, 4, 8})
    for (int sharer = 0; sharer < sharers; ++sharer)
      rough_points_.push_back(LobePoints::dealt(std::max(lobe_rays, 1), sharers, sharer));
  for (int looker = 0; looker < kLookers; ++looker) look_points_.push_back(LobePoints::dealt(kLookers, kLookers, looker));
}

bool MirroredLight::mirrors(const Frame& frame, const SurfacePoint& point) const {
  const auto& m = frame.surface.material_at(point, materials_);
  return m.base_color_metallic.w > 0 || m.dielectric.x > 0;
}

bool MirroredLight::is_rough(const Frame& frame, const SurfacePoint& point) const {
  return frame.surface.material_at(point, materials_).emissive_roughness.w >= shading::kMinHighlightRoughness;
}

/// How many pixels share a lobe's rays. The parts of an outline's pixel share with nobody, and take half of the
/// rays; of a wide lobe, much of which lies below a surface that is seen edge on, they take all.
int MirroredLight::sharers_of(const Frame& frame, std::size_t index) const {
  const SurfacePoint& point = frame.surface.points[index];
  if (!is_rough(frame, point) || lobe_rays_ == 0) return 1;
  const float roughness = frame.surface.material_at(point, materials_).emissive_roughness.w;
  if (point.coverage < 1) return roughness * roughness < kWideLobe ? 2 : 1;
  const float footprint = glm::length(footprint_x_[index]) + glm::length(footprint_y_[index]);
  const float share = footprint / (roughness * roughness);
  if (near_hit_[point.pixel]) return share <= kFootprintOf2 ? 2 : 1;
  return share <= kFootprintOf8 ? 8 : share <= kFootprintOf4 ? 4 : share <= kFootprintOf2 ? 2 : 1;
}

Lobe MirroredLight::lobe_of(const Frame& frame, std::size_t index) const {
  const SurfacePoint& point = frame.surface.points[index];
  const float roughness = frame.surface.material_at(point, materials_).emissive_roughness.w;
  // Without rays of its own the whole lobe is read from the prefiltered probe, in the mirror direction.
  return {point.to_viewer, point.normal, footprint_x_[index], footprint_y_[index], lobe_rays_ > 0 ? roughness * roughness : 0};
}

/// How rough the surface is whose whole lobe is as wide as what one of the point's rays stands for.
float MirroredLight::ray_roughness(const Frame& frame, const SurfacePoint& point) const {
  const float roughness = frame.surface.material_at(point, materials_).emissive_roughness.w;
  if (lobe_rays_ == 0) return roughness;
  const int lobe_size = is_rough(frame, point) ? lobe_rays_ : kPolishedRays;
  return std::pow(static_cast<float>(lobe_size), -0.25f) * roughness;
}

/// The point's own part of its lobe. An outline's pixel needs no more than a ray of a polished one: its samples are the rays.
const LobePoints& MirroredLight::points_of(const Frame& frame, std::size_t index) const {
  const SurfacePoint& point = frame.surface.points[index];
  if (!is_rough(frame, point)) return point.coverage < 1 ? single_point_ : polished_points_;
  const int sharers = sharers_of(frame, index);
  const PixelRect& rect = frame.surface.rect;
  const int x = rect.x + static_cast<int>(point.pixel) % rect.width, y = rect.y + static_cast<int>(point.pixel) / rect.width;
  const int of2 = (x ^ y) & 1, of4 = (x & 1) | (y & 1) << 1, of8 = (x & 3) | (y & 1) << 2;
  const int sharer = sharers == 1 ? 0 : sharers == 2 ? of2 : sharers == 4 ? of4 : of8;
  return rough_points_[static_cast<std::size_t>(sharers - 1 + sharer)];
}

/// Where the point looks whether the object is mirrored.
const LobePoints& MirroredLight::look_point_of(const Frame& frame, std::size_t index) const {
  const SurfacePoint& point = frame.surface.points[index];
  if (!is_rough(frame, point)) return single_point_;
  const PixelRect& rect = frame.surface.rect;
  const int x = rect.x + static_cast<int>(point.pixel) % rect.width, y = rect.y + static_cast<int>(point.pixel) / rect.width;
  return look_points_[static_cast<std::size_t>((x & (kLookersAcross - 1)) + kLookersAcross * (y & (kLookersAcross - 1)))];
}

void MirroredLight::find_mirror_directions(const Frame& frame) {
  const auto& points = frame.surface.points;
  mirror_.resize(points.size()), footprint_x_.resize(points.size()), footprint_y_.resize(points.size());
  for_chunks(points.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) mirror_[i] = glm::reflect(-points[i].to_viewer, points[i].normal);
  });
  for_chunks(points.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) find_footprints(frame, i);
  });
}

/// How the mirror direction changes from pixel to pixel.
void MirroredLight::find_footprints(const Frame& frame, std::size_t index) {
  const PixelRect& rect = frame.surface.rect;
  const std::vector<SurfacePoint>& points = frame.surface.points;
  const std::vector<std::int32_t>& firsts = frame.surface.first;
  const SurfacePoint& point = points[index];
  const int x = static_cast<int>(point.pixel) % rect.width, y = static_cast<int>(point.pixel) / rect.width;
  const auto change = [&](int dx, int dy) -> glm::vec3 {
    for (const int way : {1, -1}) {
      const int u = x + way * dx, v = y + way * dy;
      if (u < 0 || v < 0 || u >= rect.width || v >= rect.height) continue;
      const std::int32_t there = firsts[static_cast<std::size_t>(v) * rect.width + u];
      if (there < 0 || points[there].material != point.material) continue;
      const glm::vec3 step = static_cast<float>(way) * (mirror_[there] - mirror_[index]);
      if (glm::dot(step, step) < kMaxFootprint * kMaxFootprint) return step;
    }
    return glm::vec3(0);
  };
  footprint_x_[index] = change(1, 0);
  footprint_y_[index] = change(0, 1);
}

/// A ray of each pixel tells where the object may be mirrored at all: the rest is traced there and around.
void MirroredLight::look_for_object(const Frame& frame) {
  const PixelRect& rect = frame.surface.rect;
  const std::vector<SurfacePoint>& points = frame.surface.points;
  const std::vector<std::int32_t>& firsts = frame.surface.first;
  hit_.assign(firsts.size(), 0);
  near_hit_.assign(firsts.size(), 0);
  for_chunks(points.size(), [&](std::size_t first, std::size_t last) {
    thread_local std::vector<MirrorRay> rays;
    thread_local LobeDirections directions;
    thread_local std::vector<std::size_t> of;
    rays.clear(), of.clear();
    for (std::size_t i = first; i < last; ++i) {
      if (!mirrors(frame, points[i])) continue;
      directions.find(lobe_of(frame, i), look_point_of(frame, i), 1);
      rays.push_back({rays_.start(points[i].position_m, points[i].normal), directions.direction(0), 0, 0, 0});
      of.push_back(points[i].pixel);
    }
    rays_.look(rays);
    for (std::size_t k = 0; k < rays.size(); ++k)
      if (rays[k].meets_object) hit_[of[k]] = 1;
  });
  constexpr int kAround = 3;
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x) {
      if (!hit_[static_cast<std::size_t>(y) * rect.width + x]) continue;
      const int left = std::max(x - kAround, 0), right = std::min(x + kAround, rect.width - 1);
      for (int v = std::max(y - kAround, 0); v <= std::min(y + kAround, rect.height - 1); ++v)
        std::fill(&near_hit_[static_cast<std::size_t>(v) * rect.width + left],
                  &near_hit_[static_cast<std::size_t>(v) * rect.width + right] + 1, char{1});
    }
}

/// Adds what the rays see to the sums of their points.
void MirroredLight::add_seen(const Frame& frame, const PointRays& seen) {
  const auto with_lights = [&](const SurfacePoint& point) { return !(frame.has_highlights && is_rough(frame, point)); };
  const auto find = [&](std::size_t i) -> Surroundings::Target {
    const MirrorRay& ray = seen.rays[i];
    if (ray.meets_object) return {};
    return frame.around.find(ray.origin_m, ray.direction, ray.spread, ray.roughness,
                             with_lights(frame.surface.points[seen.of[i].point]));
  };
  Surroundings::for_each_target(seen.rays.size(), find, [&](std::size_t i, const Surroundings::Target& target) {
    const auto [point, weight] = seen.of[i];
    const MirrorRay& ray = seen.rays[i];
    sums_[point].light += weight * (ray.meets_object ? ray.radiance : frame.around.radiance(target));
    sums_[point].weight += weight;
  });
}

/// Finds what the points' own rays see: the sum of their light, and of their weights.
void MirroredLight::trace(const Frame& frame, std::size_t first, std::size_t last) {
  thread_local PointRays near_object, free;
  thread_local LobeDirections directions;
  for (PointRays* some : {&near_object, &free}) some->rays.clear(), some->of.clear();
  for (std::size_t i = first; i < last; ++i) {
    const SurfacePoint& point = frame.surface.points[i];
    sums_[i] = {};
    if (!mirrors(frame, point)) continue;
    const LobePoints& own = points_of(frame, i);
    const Lobe lobe = lobe_of(frame, i);
    directions.find(lobe, own, own.number.size());
    const glm::vec3 start_m = rays_.start(point.position_m, point.normal);
    const float roughness = ray_roughness(frame, point);
    const float spread = roughness * roughness + 0.25f * glm::length(lobe.footprint_x + lobe.footprint_y);
    auto& [rays, of] = lobe_rays_ > 0 && near_hit_[point.pixel] ? near_object : free;
    for (std::size_t k = 0; k < own.number.size(); ++k) {
      if (directions.weight(k) == 0) continue;
      MirrorRay& ray = rays.emplace_back();  // set in its place: a copy of what was just written waits for it
      ray.origin_m = start_m, ray.direction = directions.direction(k);
      ray.spread = spread, ray.roughness = roughness, ray.index = own.number[k];
      of.push_back({i, directions.weight(k)});
    }
  }
  rays_.trace(near_object.rays);
  add_seen(frame, near_object);
  add_seen(frame, free);
}

/// What the point's rays and those of its neighbours find.
MirroredLight::Sum MirroredLight::sum_around(const Frame& frame, std::size_t index, int sharers) const {
  const PixelRect& rect = frame.surface.rect;
  const std::vector<SurfacePoint>& points = frame.surface.points;
  const std::vector<std::int32_t>& firsts = frame.surface.first;
  const SurfacePoint& point = points[index];
  const auto& says = sharers == 8 ? kSaysOf8 : sharers == 4 ? kSaysOf4 : kSaysOf2;
  const float roughness = frame.surface.material_at(point, materials_).emissive_roughness.w;
  const float reach = (sharers == 2 ? kSharedTurnOf2 : kSharedTurn) * roughness * roughness;
  const int x = static_cast<int>(point.pixel) % rect.width, y = static_cast<int>(point.pixel) / rect.width;
  Sum sum;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, rect.height - 1); ++v) {
    for (int u = std::max(x - 2, 0); u <= std::min(x + 2, rect.width - 1); ++u) {
      const float say = says[v - y + 1][u - x + 2];
      const std::int32_t there = firsts[static_cast<std::size_t>(v) * rect.width + u];
      if (say == 0 || there < 0 || points[there].material != point.material) continue;
      const glm::vec3 turn = mirror_[there] - mirror_[index];
      const float alike = say * (1 - glm::dot(turn, turn) / (reach * reach));
      if (!(alike > 0) || std::abs(points[there].depth_m - point.depth_m) > kSharedDepth * point.depth_m) continue;
      sum.light += alike * sums_[there].light, sum.weight += alike * sums_[there].weight;
    }
  }
  return sum;
}

/// The lobe's mean, by the point's rays and those of neighbours with much the same mirror direction.
glm::vec3 MirroredLight::shared(const Frame& frame, std::size_t index) const {
  const std::vector<SurfacePoint>& points = frame.surface.points;
  const SurfacePoint& point = points[index];
  const auto& m = frame.surface.material_at(point, materials_);
  const int sharers = sharers_of(frame, index);
  Sum sum;
  if (sharers == 1 || point.coverage < 1) {
    sum = sums_[index];
  } else {
    sum = sum_around(frame, index, sharers);
  }
  if (sum.weight > 0) return sum.light / sum.weight;
  return frame.around.probe_radiance(mirror_[index], m.emissive_roughness.w, !(frame.has_highlights && is_rough(frame, point)));
}

std::span<const glm::vec3> MirroredLight::find(const VisibleSurface& surface, const Surroundings& around, bool has_highlights) {
  const Frame frame{surface, around, has_highlights};
  result_.assign(surface.points.size(), glm::vec3(0));
  if (!materials_.reflects) return result_;
  find_mirror_directions(frame);
  if (lobe_rays_ > 0) look_for_object(frame);
  sums_.resize(surface.points.size());
  for_chunks(surface.points.size(), [&](std::size_t first, std::size_t last) { trace(frame, first, last); });
  for_chunks(surface.points.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      if (mirrors(frame, surface.points[i])) result_[i] = shared(frame, i);
  });
  return result_;
}

}  // namespace catchlight::render
