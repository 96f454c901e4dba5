// The points of a bake: where their rays start, and what those see.
#pragma once

#include <vector>

#include "render/mesh/mesh.hpp"
#include "render/transfer/light_links.hpp"
#include "render/transfer/point_rays.hpp"
#include "render/transfer/receiver_grid.hpp"
#include "render/transfer/transfer_options.hpp"

namespace catchlight::render {

/// The vertices of the object and the points of the receiver's grid. Keeps references to what it is made from.
class BakePoints {
 public:
  BakePoints(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options);

  std::size_t vertices() const { return mesh_.vertices.size(); }
  std::size_t receiver_points() const { return grid_.points(); }
  const RayScene& scene() const { return scene_; }
  /// Diffuse albedo of each vertex. Metals have none.
  const std::vector<glm::vec3>& albedo() const { return albedo_; }
  /// Whether the surface around the vertex sends anything back: a texture may, where the vertex itself is black.
  bool is_diffuse(std::size_t v) const { return is_diffuse_[v] != 0; }
  /// Whether the receiver's own light reaches the object from its true place.
  bool receiver_sends_back() const { return receiver_sends_back_; }

  void send_from_vertex(std::size_t v, PointRays& rays) const;
  void send_from_receiver(std::size_t p, PointRays& rays) const;

  /// Adds what the point sees whose rays these are: front faces (the inside of a solid is dark), and of a vertex the receiver
  /// too. The first part is what the first so many rays see.
  void link_vertex(const PointRays& rays, int first, LightLinks& links) const;
  void link_receiver(const PointRays& rays, int first, LightLinks& links) const;

  /// The light counts what the probe saw below the plane as infinitely far away and open to the sky: this takes that out, for
  /// what a vertex meets where the plane is. Both are shares of the light that reaches the plane, so no sharp horizon has to be
  /// held by a few bands.
  glm::vec3 receiver_correction(const PointRays& rays) const;

 private:
  template <typename Visit>
  void for_rays_to_receiver(const PointRays& rays, const Visit& visit) const;

  const Mesh& mesh_;
  const ReceiverGrid& grid_;
  const TransferOptions& options_;
  RayScene scene_;
  std::vector<glm::vec3> albedo_;
  std::vector<char> is_diffuse_;
  glm::vec3 middle_m_;  ///< middle of a sphere around the object
  float radius_m_, lift_m_;
  bool receiver_sends_back_;
};

}  // namespace catchlight::render
