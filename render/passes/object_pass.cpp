#include "render/passes/object_pass.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "catchlight/util/parallel.hpp"
#include "render/passes/reflection_texture.hpp"
#include "render/rays/skip_bvh.hpp"
#include "render/surface_material.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
namespace {

/// The triangles' numbers grouped by material.
std::vector<std::size_t> triangles_by_material(const Mesh& mesh) {
  std::vector<std::size_t> order(mesh.triangle_material.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t t) { return mesh.triangle_material[t]; });
  return order;
}

/// The number of triangles whose lights are kept: those whose records fit into one storage block (128 MiB in Mesa).
int most_kept(const Mesh& mesh) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limit);
  const std::size_t fitting = static_cast<std::size_t>(limit) / sizeof(shader_interface::TriangleLights);
  return static_cast<int>(std::min(fitting, mesh.triangle_material.size()));
}

/// 1 for a vertex above whose plane some of the object lies, else 0: rays from there meet nothing of it.
std::vector<float> find_mirrors_object(const SkipBvh& bvh, const Mesh& mesh, float ray_start_m) {
  std::vector<float> result(mesh.vertices.size());
  constexpr std::size_t kAtOnce = 1024;
  parallel_for((result.size() + kAtOnce - 1) / kAtOnce, 0, [&](std::size_t chunk) {
    for (std::size_t v = chunk * kAtOnce; v < std::min((chunk + 1) * kAtOnce, result.size()); ++v) {
      const glm::vec3 normal = mesh.vertices[v].normal / std::max(glm::length(mesh.vertices[v].normal), 1e-20f);
      result[v] = reaches_above(bvh, mesh, mesh.vertices[v].position_m, normal, ray_start_m) ? 1.0f : 0.0f;
    }
  });
  return result;
}

void set_attribute(GLuint array, GLuint attribute, GLuint binding, std::size_t offset, int floats = 3) {
  glEnableVertexArrayAttrib(array, attribute);
  glVertexArrayAttribFormat(array, attribute, floats, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, attribute, binding);
}

}  // namespace

ObjectPass::ObjectPass(const Mesh& mesh, LitPoints vertices_lit, const ReflectionMap& reflections, const ReflectionMap& rest,
                       float ray_start_m, ShaderLibrary& shaders)
    : program_(shaders.program({.vertex = "object.vert", .fragment = "object.frag"})),
      vertex_light_(std::move(vertices_lit)),
      vertex_lights_capture_("vertex_lights.vert", {"irradiance_over_pi", "lit", "dark"}, sizeof(shader_interface::VertexLights),
                             shaders),
      triangle_lights_capture_("triangle_lights.vert", {"flux_red", "flux_green", "flux_blue", "shining", "mixed"},
                               sizeof(shader_interface::TriangleLights), shaders),
      kept_triangles_(most_kept(mesh)),
      vertex_lights_(make_buffer("vertex lights", mesh.vertices.size() * sizeof(shader_interface::VertexLights), nullptr)),
      triangle_lights_(make_buffer(
          "triangle lights", static_cast<std::size_t>(kept_triangles_) * sizeof(shader_interface::TriangleLights), nullptr)),
      vertices_(make_buffer("object vertices", std::span<const Vertex>(mesh.vertices))),
      vertex_array_(make_vertex_array("object")),
      probe_(make_reflection_texture(reflections)),
      rest_(make_reflection_texture(rest)),
      brdf_table_(make_brdf_texture()) {
  upload_mesh(mesh);
  upload_materials(mesh);
  upload_hierarchy(mesh, ray_start_m);
}

void ObjectPass::upload_mesh(const Mesh& mesh) {
  std::vector<std::uint32_t> indices;
  indices.reserve(mesh.indices.size());
  for (const std::size_t triangle : triangles_by_material(mesh)) {
    const int material = mesh.triangle_material[triangle];
    if (batches_.empty() || batches_.back().material != material)
      batches_.push_back({static_cast<int>(indices.size()), 0, material});
    indices.insert(indices.end(), &mesh.indices[3 * triangle], &mesh.indices[3 * triangle] + 3);
    batches_.back().index_count += 3;
  }
  indices_ = make_buffer("object indices", std::span<const std::uint32_t>(indices));
  const GLuint array = vertex_array_.id();
  glVertexArrayElementBuffer(array, indices_.id());
  glVertexArrayVertexBuffer(array, 0, vertices_.id(), 0, sizeof(Vertex));
  glVertexArrayVertexBuffer(array, 1, vertex_light_.radiance(), 0, sizeof(glm::vec3));
  set_attribute(array, ATTRIBUTE_POSITION, 0, offsetof(Vertex, position_m));
  set_attribute(array, ATTRIBUTE_NORMAL, 0, offsetof(Vertex, normal));
  set_attribute(array, ATTRIBUTE_COLOR, 0, offsetof(Vertex, color));
  set_attribute(array, ATTRIBUTE_IRRADIANCE, 1, 0);
}

void ObjectPass::upload_materials(const Mesh& mesh) {
  const auto [materials, emits, reflects] = surface_materials(mesh);
  emits_ = emits, reflects_ = reflects;
  materials_ = make_buffer("materials", std::span<const shader_interface::SurfaceMaterial>(materials));
}

void ObjectPass::upload_hierarchy(const Mesh& mesh, float ray_start_m) {
  SkipBvh bvh;
  if (reflects_) bvh = build_skip_bvh(mesh);
  std::vector<glm::uvec4> triangles;
  for (const std::uint32_t triangle : bvh.triangles) {
    const std::uint32_t* corner = &mesh.indices[3 * static_cast<std::size_t>(triangle)];
    triangles.emplace_back(corner[0], corner[1], corner[2], mesh.triangle_material[triangle]);
  }
  bvh_nodes_ = make_buffer("hierarchy", std::span<const SkipNode>(bvh.nodes));
  bvh_triangles_ = make_buffer("hierarchy's triangles", std::span<const glm::uvec4>(triangles));
  const std::vector<float> mirrors_object = find_mirrors_object(bvh, mesh, ray_start_m);
  mirrors_object_ = make_buffer("mirrors object", std::span<const float>(mirrors_object));
  const GLuint array = vertex_array_.id();
  glVertexArrayVertexBuffer(array, 2, mirrors_object_.id(), 0, sizeof(float));
  set_attribute(array, ATTRIBUTE_MIRRORS_OBJECT, 2, 0, 1);
}

void ObjectPass::light_by(const LightTransfer& light, const ShadowedLights& lights) {
  vertex_light_.evaluate(light);
  if (lights.count() == 0) return;
  lights.bind();
  bind_storage(BINDING_VERTICES, vertices_.id());
  vertex_lights_capture_.run(vertex_lights_.id(), 0, vertex_light_.count());
  bind_storage(BINDING_VERTEX_LIGHTS, vertex_lights_.id());
  bind_storage(BINDING_CORNERS, indices_.id());
  triangle_lights_capture_.run(triangle_lights_.id(), 0, kept_triangles_);
}

void ObjectPass::draw_geometry() const {
  glBindVertexArray(vertex_array_.id());
  if (!batches_.empty()) {
    const Batch& last = batches_.back();
    glDrawElements(GL_TRIANGLES, last.first_index + last.index_count, GL_UNSIGNED_INT, nullptr);
  }
}

void ObjectPass::draw(const ObjectTarget& target, const PixelRect& rect, int frame_width, int frame_height) const {
  const float no_color[4] = {0, 0, 0, 0}, farthest = 0;
  reset_state();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  set_viewport(rect, frame_width, frame_height);
  for (int i = 0; i < ObjectTarget::kLayers; ++i) glClearNamedFramebufferfv(target.framebuffer(), GL_COLOR, i, no_color);
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(target.framebuffer(), GL_DEPTH, 0, &farthest);

  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glFrontFace(GL_CW);  // the frame's top row is GL's lowest
  glUseProgram(program_.id());
  glBindVertexArray(vertex_array_.id());
  glBindTextureUnit(TEXTURE_PROBE, probe_.id());
  glBindTextureUnit(TEXTURE_BRDF, brdf_table_.id());
  glBindTextureUnit(TEXTURE_REST, rest_.id());
  bind_storage(BINDING_BVH_NODES, bvh_nodes_.id());
  bind_storage(BINDING_BVH_TRIANGLES, bvh_triangles_.id());
  bind_storage(BINDING_VERTICES, vertices_.id());
  bind_storage(BINDING_IRRADIANCE, vertex_light_.radiance());
  bind_storage(BINDING_MATERIALS, materials_.id());
  bind_storage(BINDING_VERTEX_LIGHTS, vertex_lights_.id());
  bind_storage(BINDING_TRIANGLE_LIGHTS, triangle_lights_.id());
  for (const Batch& batch : batches_) {
    program_.set("material_index", batch.material);
    program_.set("first_triangle", batch.first_index / 3);
    const auto offset = static_cast<std::uintptr_t>(batch.first_index) * sizeof(std::uint32_t);
    glDrawElements(GL_TRIANGLES, batch.index_count, GL_UNSIGNED_INT, std::bit_cast<const void*>(offset));
  }
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDisable(GL_DEPTH_TEST);
  target.resolve(rect.width, rect.height);
}

}  // namespace catchlight::render
