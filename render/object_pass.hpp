// Draws the object: diffuse light from its transfer, reflections from the probe; antialiased in linear light.
#pragma once

#include <string>
#include <vector>

#include "render/gl_objects.hpp"
#include "render/light_transfer.hpp"
#include "render/mesh.hpp"
#include "render/prefilter.hpp"
#include "render/render_target.hpp"

namespace catchlight::render {

class ObjectPass {
 public:
  ObjectPass(const Mesh& mesh, LitPoints vertices_lit, const ReflectionMap& reflections, const std::string& shader_folder);

  /// The object's exit radiance under `light`; needed again whenever the light turns.
  void light_by(const LightTransfer& light) { exit_radiance_.evaluate(light); }

  /// Into `target`, of which `rect` (pixels of a frame of that size) is drawn. Needs the ViewUniforms bound.
  void draw(const ObjectTarget& target, const PixelRect& rect, int frame_width, int frame_height) const;

 private:
  /// Triangles of one material.
  struct Batch {
    int first_index, index_count, material;
  };

  void upload_mesh(const Mesh& mesh);
  void upload_materials(const Mesh& mesh);

  GlProgram program_;
  LitPoints exit_radiance_;
  GlBuffer vertices_, indices_, materials_;
  GlVertexArray vertex_array_;
  GlTexture probe_, brdf_table_;
  std::vector<Batch> batches_;
  int material_stride_ = 0;  ///< bytes
};

}  // namespace catchlight::render
