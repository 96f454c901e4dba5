#include "render/cpu/surface/visible_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catchlight/util/parallel.hpp"
#include "render/frame_plan.hpp"
#include "shaders/shading.h"

namespace catchlight::render {
namespace {

constexpr int kBandRows = 8, kTileColumns = 8;
constexpr std::size_t kMaxPieces = 4096;

/// Samples of one pixel that lie on much the same surface are shaded together: cosine of 25 degrees between their normals, and
/// shares of the distance.
constexpr float kSameNormal = 0.9f, kSameDepth = 0.02f;
/// Neighbouring pixels whose depths differ by this share of them show different surfaces.
constexpr float kStepDepth = 0.02f;

/// OpenGL's usual pattern of four; else low-discrepancy.
std::vector<glm::vec2> sample_pattern(int count) {
  if (count == 1) return {{0, 0}};
  if (count == 4) return {{-0.125f, -0.375f}, {0.375f, -0.125f}, {-0.375f, 0.125f}, {0.125f, 0.375f}};
  std::vector<glm::vec2> result;
  result.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    result.push_back(glm::fract(glm::vec2((static_cast<float>(i) + 0.5f) / static_cast<float>(count),
                                          0.5f + 0.6180339887f * static_cast<float>(i))) -
                     0.5f);
  return result;
}

}  // namespace

struct SurfaceFinder::Frame {
  const FrameView& view;
  const DistortionLimit& limit;
  const PixelRays& pixel_rays;
  PixelRect rect;
  std::span<const glm::vec3> irradiance_over_pi;
  glm::vec3 eye_tag_m;
  glm::mat3 tag_from_camera;

  /// Sets a ray, as long as it is deep; one that meets nothing where the lens sees nothing.
  void set_ray(RayStream& rays, std::size_t ray, const glm::vec2& normalized) const {
    constexpr float kFarthest = 1e6f;  // false for NaN, which Embree does not take
    const bool is_seen = std::abs(normalized.x) < kFarthest && std::abs(normalized.y) < kFarthest;
    const auto near_m = static_cast<float>(kNear_m);
    rays.set(ray, eye_tag_m, tag_from_camera * glm::vec3(is_seen ? normalized : glm::vec2(0), 1.0f), near_m,
             is_seen ? std::numeric_limits<float>::infinity() : near_m);
  }
};

SurfaceFinder::SurfaceFinder(const Mesh& mesh, const RayScene& rays, int samples, std::vector<char> is_polished)
    : mesh_(mesh),
      rays_(rays),
      outline_(mesh),
      sample_offsets_px_(sample_pattern(samples)),
      is_polished_(std::move(is_polished)) {
  const std::size_t triangles = mesh.indices.size() / 3, triangles_a_piece = 1 + triangles / kMaxPieces;
  for (std::size_t t = 0; t < triangles; ++t) {
    if (t % triangles_a_piece == 0) pieces_.emplace_back();
    pieces_.back().add(triangle_bounds(mesh, t));
  }
}

SurfaceFinder::Hit SurfaceFinder::hit_of(const RayStream& rays, std::size_t ray) const {
  Hit hit{rays.triangle[ray], {rays.u[ray], rays.v[ray]}, rays.far[ray], !rays.is_front_facing(ray)};
  const std::uint32_t* corner = &mesh_.indices[3 * static_cast<std::size_t>(hit.triangle)];
  const auto normal = [&](int k) { return mesh_.vertices[corner[k]].normal; };
  const glm::vec3 sum = (1 - hit.weights.x - hit.weights.y) * normal(0) + hit.weights.x * normal(1) + hit.weights.y * normal(2);
  hit.normal = sum / (std::max(glm::length(sum), 1e-20f) * (hit.is_back ? -1.0f : 1.0f));
  return hit;
}

/// The pixels of the rectangle that an edge crosses.
void SurfaceFinder::mark_outline(const Frame& frame) {
  const PixelRect& rect = frame.rect;
  is_outline_.assign(static_cast<std::size_t>(rect.width) * rect.height, 0);
  if (sample_offsets_px_.size() == 1) return;
  const auto mark = [&](int x, int y) { is_outline_[static_cast<std::size_t>(y) * rect.width + x] = 1; };
  const glm::dvec2 corner(rect.x, rect.y);
  outline_.for_each_seen(frame.eye_tag_m, [&](const glm::vec3& from_tag_m, const glm::vec3& to_tag_m) {
    glm::dvec3 from = frame.view.camera_from_tag * glm::dvec3(from_tag_m);
    glm::dvec3 to = frame.view.camera_from_tag * glm::dvec3(to_tag_m);
    if (from.z < kNear_m && to.z < kNear_m) return;
    if (from.z < kNear_m) from += (kNear_m - from.z) / (to.z - from.z) * (to - from);
    if (to.z < kNear_m) to += (kNear_m - to.z) / (from.z - to.z) * (from - to);
    const auto from_px = project_px(frame.view.camera, from, &frame.limit),
               to_px = project_px(frame.view.camera, to, &frame.limit);
    if (from_px && to_px) for_each_crossed_pixel(*from_px - corner, *to_px - corner, rect.width, rect.height, mark);
  });
}

SurfacePoint SurfaceFinder::point_at(const Frame& frame, const Hit& hit) const {
  const std::uint32_t* corner = &mesh_.indices[3 * static_cast<std::size_t>(hit.triangle)];
  const Vertex &a = mesh_.vertices[corner[0]], &b = mesh_.vertices[corner[1]], &c = mesh_.vertices[corner[2]];
  const glm::vec3 w(1 - hit.weights.x - hit.weights.y, hit.weights);
  SurfacePoint point;
  point.position_m = w.x * a.position_m + w.y * b.position_m + w.z * c.position_m;
  point.normal = hit.normal;
  point.color = w.x * a.color + w.y * b.color + w.z * c.color;
  point.irradiance_over_pi = w.x * frame.irradiance_over_pi[corner[0]] + w.y * frame.irradiance_over_pi[corner[1]] +
                             w.z * frame.irradiance_over_pi[corner[2]];
  point.triangle = hit.triangle;
  point.weights = hit.weights;
  point.depth_m = hit.depth_m;
  point.material = mesh_.triangle_material[hit.triangle];
  point.is_back = hit.is_back;
  return point;
}

namespace {

/// Sums become means, and the normal is bent back to grazing where it looks away from the viewer, as interpolated ones may at the
/// outline.
void finish(SurfacePoint& point, int count, const glm::vec3& eye_tag_m) {
  const float scale = 1 / static_cast<float>(count);
  point.position_m *= scale, point.color *= scale, point.irradiance_over_pi *= scale, point.depth_m *= scale;
  point.normal /= std::max(glm::length(point.normal), 1e-20f);
  point.to_viewer = glm::normalize(eye_tag_m - point.position_m);
  const float n_v = glm::dot(point.normal, point.to_viewer);
  if (n_v < 0) point.normal -= n_v * point.to_viewer;
  if (!(glm::dot(point.normal, point.normal) > 1e-12f))
    point.normal = point.to_viewer;  // there is none, or it looks straight away
  else if (n_v < 0)
    point.normal = glm::normalize(point.normal);
}

void add(SurfacePoint& sum, const SurfacePoint& other) {
  sum.position_m += other.position_m, sum.normal += other.normal, sum.color += other.color;
  sum.irradiance_over_pi += other.irradiance_over_pi, sum.depth_m += other.depth_m;
}

}  // namespace

/// Marks the tiles that the object may be seen in, by the boxes of pieces. A point of one is c + d in the camera frame, c its
/// middle, |d| <= h along each axis. With n = c.xy / c.z, (c + d).xy / (c + d).z - n = (d.xy - n d.z) / (c.z + d.z) is at most
/// (h.xy + |n| h.z) / (c.z - h.z) long. h is grown by tens of times what floats round here and in rays, the picture of the box
/// by a pixel: samples lie half of one away from middles.
void SurfaceFinder::mark_tiles(const Frame& frame) {
  const CameraModel& camera = frame.view.camera;
  const glm::ivec2 count((frame.rect.width + kTileColumns - 1) / kTileColumns, (frame.rect.height + kBandRows - 1) / kBandRows);
  const auto mark_all = [&](char is_marked) { is_seen_tile_.assign(static_cast<std::size_t>(count.x) * count.y, is_marked); };
  mark_all(0);
  if (camera.has_distortion()) return mark_all(1);
  const glm::mat3 r(frame.view.camera_from_tag.rotation), sizes(glm::abs(r[0]), glm::abs(r[1]), glm::abs(r[2]));
  const glm::vec2 tiles_a_pixel = 1.0f / glm::vec2(kTileColumns, kBandRows);
  const glm::vec2 scale = glm::vec2(camera.fx_px, camera.fy_px) * tiles_a_pixel;
  const glm::vec2 origin = glm::vec2(camera.cx_px - frame.rect.x, camera.cy_px - frame.rect.y) * tiles_a_pixel;
  for (const Bounds& piece : pieces_) {
    const glm::vec3 c = r * (piece.middle_m() - frame.eye_tag_m);
    const glm::vec3 h = sizes * (0.5f * (piece.max_m - piece.min_m)) + 1e-5f * (std::abs(c.x) + std::abs(c.y) + std::abs(c.z));
    if (!(c.z - h.z > static_cast<float>(kNear_m))) return mark_all(1);
    const glm::vec2 n = glm::vec2(c) * (1 / c.z), reach = (glm::vec2(h) + glm::abs(n) * h.z) * (1 / (c.z - h.z));
    const glm::vec2 middle = origin + scale * n, half = scale * reach + tiles_a_pixel;
    const glm::ivec2 first(glm::clamp(middle - half, glm::vec2(0), glm::vec2(count)));
    const glm::ivec2 end(glm::clamp(middle + half + 1.0f, glm::vec2(0), glm::vec2(count)));
    for (int y = first.y; y < end.y; ++y)
      for (int x = first.x; x < end.x; ++x) is_seen_tile_[static_cast<std::size_t>(y) * count.x + x] = 1;
  }
}

/// Visits the pixels of a band's marked tiles, tile after tile, so that those that follow each other are neighbours in the
/// picture.
template <typename Visit>
void SurfaceFinder::for_each_pixel(const PixelRect& rect, int band, const Visit& visit) const {
  const int top = band * kBandRows, bottom = std::min(top + kBandRows, rect.height);
  const std::size_t first_tile = static_cast<std::size_t>(band) * ((rect.width + kTileColumns - 1) / kTileColumns);
  for (int left = 0; left < rect.width; left += kTileColumns) {
    if (!is_seen_tile_[first_tile + left / kTileColumns]) continue;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < std::min(left + kTileColumns, rect.width); ++x)
        visit(x, y, static_cast<std::size_t>(y) * rect.width + x);
  }
}

/// The samples of a pixel that the outline crosses, from `first_ray`, grouped by surface.
void SurfaceFinder::add_samples(const Frame& frame, const RayStream& rays, std::size_t first_ray, std::size_t pixel,
                                std::vector<SurfacePoint>& points) const {
  const std::size_t first = points.size(), samples = sample_offsets_px_.size();
  std::array<int, 16> counts{};
  for (std::size_t ray = first_ray; ray < first_ray + samples; ++ray) {
    if (!rays.meets(ray)) continue;
    const SurfacePoint found = point_at(frame, hit_of(rays, ray));
    std::size_t at = first;
    for (; at < points.size(); ++at) {
      const SurfacePoint& group = points[at];
      const auto count = static_cast<float>(counts[at - first]);
      if (group.material == found.material && !is_polished_[found.material] &&
          glm::dot(group.normal, found.normal) > kSameNormal * count &&
          std::abs(group.depth_m - count * found.depth_m) < kSameDepth * count * found.depth_m)
        break;
    }
    if (at == points.size())
      points.push_back(found);
    else
      add(points[at], found);
    ++counts[at - first];
  }
  for (std::size_t at = first; at < points.size(); ++at) {
    points[at].pixel = static_cast<std::uint32_t>(pixel);
    points[at].coverage = static_cast<float>(counts[at - first]) / static_cast<float>(samples);
    finish(points[at], counts[at - first], frame.eye_tag_m);
  }
}

/// What the middles of a band's pixels show.
void SurfaceFinder::trace_band(const Frame& frame, int band) {
  thread_local RayStream rays;
  const PixelRect& rect = frame.rect;
  const std::size_t begin = static_cast<std::size_t>(band) * kBandRows * rect.width;
  for (Hit& hit : std::span(hits_).subspan(begin, std::min(hits_.size() - begin, std::size_t{kBandRows} * rect.width)))
    hit.triangle = RayStream::kNothing;
  std::size_t ray = 0;
  for_each_pixel(rect, band, [&](int, int, std::size_t) { ++ray; });
  if (ray == 0) return;
  rays.resize(std::exchange(ray, 0));
  for_each_pixel(rect, band,
                 [&](int x, int y, std::size_t) { frame.set_ray(rays, ray++, frame.pixel_rays.at(rect.x + x, rect.y + y)); });
  rays_.closest_hits(rays, Coherence::coherent);
  ray = 0;
  for_each_pixel(rect, band, [&](int, int, std::size_t pixel) {
    if (rays.meets(ray)) hits_[pixel] = hit_of(rays, ray);
    ++ray;
  });
}

/// Whether two neighbours' surfaces do not go on from one to the other, as where parts go through each other.
bool SurfaceFinder::is_step(const Hit& a, const Hit& b) {
  if (a.triangle == b.triangle || b.triangle == RayStream::kNothing) return false;
  return std::abs(a.depth_m - b.depth_m) > kStepDepth * a.depth_m || glm::dot(a.normal, b.normal) < kSameNormal;
}

/// Marks the pixels of a band that differ much from those around.
void SurfaceFinder::mark_steps(const Frame& frame, int band) {
  const PixelRect& rect = frame.rect;
  for (int y = band * kBandRows; y < std::min((band + 1) * kBandRows, rect.height); ++y) {
    for (int x = 0; x < rect.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * rect.width + x;
      if (is_outline_[pixel] || hits_[pixel].triangle == RayStream::kNothing) continue;
      const auto differs = [&](int dx, int dy) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= rect.width || y + dy >= rect.height) return false;
        return is_step(hits_[pixel], hits_[static_cast<std::size_t>(y + dy) * rect.width + (x + dx)]);
      };
      is_outline_[pixel] = differs(1, 0) || differs(0, 1) || differs(-1, 0) || differs(0, -1);
    }
  }
}

void SurfaceFinder::put_band(const Frame& frame, int band, std::vector<SurfacePoint>& points) const {
  thread_local RayStream rays;
  const PixelRect& rect = frame.rect;
  const std::size_t samples = sample_offsets_px_.size();
  std::size_t crossed = 0;
  for_each_pixel(rect, band, [&](int, int, std::size_t pixel) { crossed += is_outline_[pixel] != 0; });
  rays.resize(crossed * samples);
  std::size_t ray = 0;
  for_each_pixel(rect, band, [&](int x, int y, std::size_t pixel) {
    if (!is_outline_[pixel]) return;
    for (const glm::vec2& offset : sample_offsets_px_)
      frame.set_ray(rays, ray++, frame.pixel_rays.at(rect.x + x, rect.y + y, offset));
  });
  if (crossed > 0) rays_.closest_hits(rays, Coherence::coherent);
  points.clear();
  ray = 0;
  for_each_pixel(rect, band, [&](int, int, std::size_t pixel) {
    if (is_outline_[pixel]) {
      add_samples(frame, rays, std::exchange(ray, ray + samples), pixel, points);
    } else if (hits_[pixel].triangle != RayStream::kNothing) {
      points.push_back(point_at(frame, hits_[pixel]));
      points.back().pixel = static_cast<std::uint32_t>(pixel);
      finish(points.back(), 1, frame.eye_tag_m);
    }
  });
}

VisibleSurface& SurfaceFinder::find(const FrameView& view, const DistortionLimit& limit, const PixelRays& pixel_rays,
                                    const PixelRect& rect, std::span<const glm::vec3> irradiance_over_pi) {
  const Frame frame{view,
                    limit,
                    pixel_rays,
                    rect,
                    irradiance_over_pi,
                    glm::vec3(inverse(view.camera_from_tag).translation_m),
                    glm::mat3(glm::transpose(view.camera_from_tag.rotation))};
  mark_outline(frame);
  mark_tiles(frame);
  bands_.resize(static_cast<std::size_t>((rect.height + kBandRows - 1) / kBandRows));
  hits_.resize(is_outline_.size());
  parallel_for(bands_.size(), 0, [&](std::size_t band) { trace_band(frame, static_cast<int>(band)); });
  if (sample_offsets_px_.size() > 1)
    parallel_for(bands_.size(), 0, [&](std::size_t band) { mark_steps(frame, static_cast<int>(band)); });
  parallel_for(bands_.size(), 0, [&](std::size_t band) { put_band(frame, static_cast<int>(band), bands_[band]); });
  surface_.rect = rect;
  surface_.points.clear();
  for (const std::vector<SurfacePoint>& band : bands_) surface_.points.insert(surface_.points.end(), band.begin(), band.end());
  surface_.first.assign(is_outline_.size(), -1);
  for (std::size_t i = surface_.points.size(); i-- > 0;) surface_.first[surface_.points[i].pixel] = static_cast<std::int32_t>(i);
  return surface_;
}

}  // namespace catchlight::render
