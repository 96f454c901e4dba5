// The light of the samples that are split off the probe, on the object: which of them each place sees, found by rays once for as
// long as the light stands still. Kept at the vertices; within triangles whose corners see different samples, on a finer lattice.
// Both are found when the camera first sees them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/cache/content_cache.hpp"
#include "render/cpu/surface/visible_surface.hpp"
#include "render/mesh/bounds.hpp"
#include "render/probe/light_samples.hpp"
#include "render/rays/ray_scene.hpp"
#include "render/render_scene.hpp"

namespace catchlight::render {

/// What is split off, at one place. Aligned, so that each lies in one line of the cache.
struct alignas(32) DirectLightNode {
  std::array<std::uint64_t, 2> seen{};  ///< a bit a sample: in front of the surface, and nothing between
  glm::vec3 irradiance{0};              ///< by those samples, on the surface there
  bool is_inside = false;               ///< within another part of the object: dark, and nobody sees it

  bool sees(std::size_t sample) const { return (seen[sample / 64] >> (sample % 64) & 1) != 0; }
};

class DirectLight {
 public:
  /// Keeps references. `object`: the box around the mesh.
  DirectLight(const Mesh& mesh, const RayScene& rays, const Bounds& object);
  ~DirectLight();
  DirectLight(const DirectLight&) = delete;
  DirectLight& operator=(const DirectLight&) = delete;

  /// Takes over the samples (tag frame; at most kMaxLightSamples). `stands_still`: they are not there for this frame alone, so
  /// that finer shadows are worth finding. Known under them is what `kept` (for that mesh and light) has; what is found besides
  /// is added to it in the end.
  void set_samples(std::span<const LightSample> samples_tag, bool stands_still, const KeyedCache& kept = {});

  std::span<const LightSample> samples() const { return samples_; }

  /// Finds what the points need, before they are asked for.
  void prepare(std::span<const SurfacePoint> points);

  /// Irradiance / pi at each vertex, for what mirrors may see; empty without samples.
  const std::vector<glm::vec3>& at_vertices_over_pi();

  /// Begins to fetch what irradiance() will read for the point, which the cache seldom holds.
  void prefetch(const SurfacePoint& point) const;

  /// Irradiance at the point. `shares`, if not null, gets how much of each sample is seen, kMaxLightSamples values.
  glm::vec3 irradiance(const SurfacePoint& point, float* shares) const;

 private:
  using Bits = std::array<std::uint64_t, 2>;
  struct Lattice {
    std::uint32_t first_node = 0;
    std::uint16_t steps = 0;  ///< along an edge; 0: the corners will do
    bool is_known = false;
  };
  struct Corners {
    const DirectLightNode* nodes[3];
    glm::vec3 weights;
  };

  DirectLightNode node_at(const glm::vec3& position_m, const glm::vec3& normal, const Bits& seen, const Bits& unknown) const;
  /// What is known of a triangle's light before its lattice is made.
  struct Known {
    std::uint32_t triangle = 0;
    Bits every{}, any{};  ///< samples that each of its corners and probes sees, or one of them
  };
  void find_vertices(std::span<const std::uint32_t> wanted);
  void look_at(Known& known) const;
  float longest_edge_m(std::uint32_t triangle) const;
  DirectLightNode node_in(std::uint32_t triangle, const glm::vec2& weights, const Bits& seen, const Bits& unknown) const;
  void fill_lattice(const Known& known);
  Corners corners_at(const SurfacePoint& point) const;
  void archive(CacheStream& file);
  void keep_findings();

  const Mesh& mesh_;
  const RayScene& rays_;
  float lift_m_, max_rounding_m_, fine_step_m_, lattice_step_m_, probed_edge_m_;
  bool stands_still_ = true;
  std::vector<LightSample> samples_;
  std::vector<DirectLightNode> vertices_, lattice_nodes_;
  std::vector<char> is_vertex_known_;
  std::vector<Lattice> lattices_;  ///< a triangle each
  std::vector<glm::vec3> at_vertices_over_pi_;
  KeyedCache kept_;
  bool has_news_ = false;  ///< more is known than is kept
};

}  // namespace catchlight::render
