// What of the object each pixel shows: found by rays, once a pixel and by several samples where its outline crosses the pixel.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/cpu/surface/mesh_outline.hpp"
#include "render/cpu/surface/pixel_rays.hpp"
#include "render/frame_view.hpp"
#include "render/mesh/bounds.hpp"
#include "render/rays/ray_scene.hpp"
#include "render/surface_material.hpp"

namespace catchlight::render {

/// A piece of surface to be shaded once: a pixel's, or the part of one that some of its samples see. Tag frame.
struct SurfacePoint {
  glm::vec3 position_m{0};
  glm::vec3 normal{0};     ///< length 1, towards the viewer
  glm::vec3 to_viewer{0};  ///< length 1
  glm::vec3 color{0};      ///< Vertex::color
  glm::vec3 irradiance_over_pi{0};
  std::uint32_t triangle = 0;
  glm::vec2 weights{0};     ///< barycentric weights of corners 1 and 2
  float depth_m = 0;        ///< along the camera's z
  float coverage = 1;       ///< share of the pixel's samples
  std::uint32_t pixel = 0;  ///< row-major in VisibleSurface::rect
  std::uint16_t material = 0;
  bool is_back = false;        ///< seen from the side where the corners wind clockwise
  std::int32_t textured = -1;  ///< in VisibleSurface::textured; -1: all of its material is the same
};

/// What textures make of a point.
struct TexturedSurface {
  shader_interface::SurfaceMaterial material;
  glm::vec3 smooth_normal{0};  ///< before a normal map bends it
  float occlusion = 1;         ///< share of the smooth light that arrives there
  bool is_bent = false;        ///< by a normal map
};

struct VisibleSurface {
  PixelRect rect;                         ///< pixels of the frame
  std::vector<SurfacePoint> points;       ///< pixel after pixel
  std::vector<std::int32_t> first;        ///< a pixel's first point; -1: it has none
  std::vector<TexturedSurface> textured;  ///< of those points that have textures

  const TexturedSurface* textured_at(const SurfacePoint& point) const {
    return point.textured < 0 ? nullptr : &textured[static_cast<std::size_t>(point.textured)];
  }
  const shader_interface::SurfaceMaterial& material_at(const SurfacePoint& point, const SurfaceMaterials& materials) const {
    const TexturedSurface* own = textured_at(point);
    return own ? own->material : materials.materials[point.material];
  }
};

class SurfaceFinder {
 public:
  /// `samples`: a pixel's where the outline crosses it. `is_polished`, a value a material: surfaces whose shading changes so much
  /// with the normal that no two samples are shaded together. Keeps references.
  SurfaceFinder(const Mesh& mesh, const RayScene& rays, int samples, std::vector<char> is_polished);

  /// What the pixels of `rect` show. `irradiance_over_pi`: a value a vertex.
  VisibleSurface& find(const FrameView& view, const DistortionLimit& limit, const PixelRays& pixel_rays, const PixelRect& rect,
                       std::span<const glm::vec3> irradiance_over_pi);

 private:
  struct Frame;
  struct Hit {
    std::uint32_t triangle = RayStream::kNothing;
    glm::vec2 weights{0};
    float depth_m = 0;
    bool is_back = false;
    glm::vec3 normal{0};  ///< interpolated, of length 1, towards the viewer
  };

  void mark_outline(const Frame& frame);
  void mark_tiles(const Frame& frame);
  template <typename Visit>
  void for_each_pixel(const PixelRect& rect, int band, const Visit& visit) const;
  void trace_band(const Frame& frame, int band);
  void mark_steps(const Frame& frame, int band);
  void put_band(const Frame& frame, int band, std::vector<SurfacePoint>& points) const;
  void add_samples(const Frame& frame, const RayStream& rays, std::size_t first_ray, std::size_t pixel,
                   std::vector<SurfacePoint>& points) const;
  static bool is_step(const Hit& a, const Hit& b);
  Hit hit_of(const RayStream& rays, std::size_t ray) const;
  SurfacePoint point_at(const Frame& frame, const Hit& hit) const;

  const Mesh& mesh_;
  const RayScene& rays_;
  MeshOutline outline_;
  std::vector<Bounds> pieces_;  ///< around a few of the mesh's triangles each
  std::vector<glm::vec2> sample_offsets_px_;
  std::vector<char> is_polished_;
  std::vector<char> is_outline_;    ///< a pixel of the rectangle each
  std::vector<char> is_seen_tile_;  ///< a tile of the rectangle each: whether the object may be seen there
  std::vector<Hit> hits_;           ///< what each pixel's middle shows
  std::vector<std::vector<SurfacePoint>> bands_;
  VisibleSurface surface_;
};

}  // namespace catchlight::render
