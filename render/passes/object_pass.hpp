// Draws the object: diffuse light from its transfer, and what it mirrors of itself, the receiver and the probe; antialiased in
// linear light.
#pragma once

#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/gl/gl_objects.hpp"
#include "render/gl/point_capture.hpp"
#include "render/gl/render_target.hpp"
#include "render/mesh/mesh.hpp"
#include "render/passes/light_transfer.hpp"
#include "render/passes/shadowed_lights.hpp"
#include "render/probe/prefilter.hpp"

namespace catchlight::render {

class ObjectPass {
 public:
  /// `rest`: the reflections less the lights that are split off; not used without any.
  /// `ray_start_m`: how far above a surface its rays start.
  ObjectPass(const Mesh& mesh, LitPoints vertices_lit, const ReflectionMap& reflections, const ReflectionMap& rest,
             float ray_start_m, ShaderLibrary& shaders);

  /// Finds what arrives at the object's vertices under `light`; needed again whenever the light turns. `lights` must be up to
  /// date.
  void light_by(const LightTransfer& light, const ShadowedLights& lights);

  /// Draws all triangles, with the program in use.
  void draw_geometry() const;

  /// Whether some material mirrors anything.
  bool reflects() const { return reflects_; }
  /// Whether some material emits light.
  bool emits() const { return emits_; }

  /// Draws into `target`, which holds `rect` (pixels of a frame of that size). Needs the ViewUniforms bound, and where their
  /// options say so the receiver (ReceiverPass::bind) and the plate's light; always the lights (ShadowedLights::bind).
  void draw(const ObjectTarget& target, const PixelRect& rect, int frame_width, int frame_height) const;

 private:
  /// Triangles of one material.
  struct Batch {
    int first_index, index_count, material;
  };

  void upload_mesh(const Mesh& mesh);
  void upload_materials(const Mesh& mesh);
  void upload_hierarchy(const Mesh& mesh, float ray_start_m);

  Program& program_;
  LitPoints vertex_light_;
  PointCapture vertex_lights_capture_, triangle_lights_capture_;
  int kept_triangles_;
  GlBuffer vertex_lights_, triangle_lights_;  ///< what vertices and triangles see of the lights; triangles as they are drawn
  GlBuffer vertices_, indices_, materials_, bvh_nodes_, bvh_triangles_, mirrors_object_;
  GlVertexArray vertex_array_;
  GlTexture probe_, rest_, brdf_table_;
  std::vector<Batch> batches_;
  bool reflects_ = false, emits_ = false;
};

}  // namespace catchlight::render
