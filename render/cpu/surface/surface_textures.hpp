// What a surface is made of at one place: its material's factors times its textures, and the normal that a normal map bends.
#pragma once

#include <glm/glm.hpp>

#include "render/cpu/surface/visible_surface.hpp"
#include "render/frame_view.hpp"
#include "render/mesh/mesh.hpp"
#include "render/surface_material.hpp"

namespace catchlight::render {

class SurfaceTextures {
 public:
  /// Keeps references.
  SurfaceTextures(const Mesh& mesh, const SurfaceMaterials& materials);

  /// Finds the points' own materials, and bends their normals.
  void apply(const FrameView& view, VisibleSurface& surface) const;

  /// The material where a ray meets a triangle, as the mean over a disc of that radius. `weights`: barycentric, of corners 1
  /// and 2.
  shader_interface::SurfaceMaterial material_at(std::uint32_t triangle, const glm::vec2& weights, float radius_m) const;

 private:
  /// How far a step on the surface goes along the triangle's edges from corner 0 to corners 1 and 2.
  struct Edges {
    glm::vec3 to_1_m, to_2_m, normal;
    glm::vec2 weights_of(const glm::vec3& step_m) const;
  };
  struct Place {
    std::uint32_t triangle;
    glm::vec2 weights, along_x, along_y;  ///< barycentric, of corners 1 and 2, and their change over the footprint
  };

  Edges edges_of(std::uint32_t triangle) const;
  glm::vec4 value(const MaterialTexture& use, const Place& place) const;
  shader_interface::SurfaceMaterial material_at(const Place& place) const;
  Place place_of(const FrameView& view, const SurfacePoint& point) const;
  glm::vec3 bent_normal(const MaterialTexture& use, const Place& place, const SurfacePoint& point) const;
  TexturedSurface look_at(const FrameView& view, SurfacePoint& point) const;

  const Mesh& mesh_;
  const SurfaceMaterials& materials_;
  bool has_textures_ = false;
};

}  // namespace catchlight::render
