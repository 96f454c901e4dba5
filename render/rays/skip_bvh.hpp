// A bounding volume hierarchy that a shader can walk without a stack: nodes lie in depth-first order, and each knows where to go
// on when it is missed. Built by Embree.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// A node as the shader reads it (std430): two vec4.
struct SkipNode {
  glm::vec3 min_m;
  std::uint32_t triangles;  ///< first * 8 + count in SkipBvh::triangles; count 0: an inner node, whose first child comes next
  glm::vec3 max_m;
  std::uint32_t skip;  ///< the node to go on with when this one is missed, or done; nodes.size() at the end
};

struct SkipBvh {
  std::vector<SkipNode> nodes;
  std::vector<std::uint32_t> triangles;  ///< numbers of the mesh's triangles, leaf by leaf
};

/// Throws Error where memory runs out. A mesh without triangles has no nodes.
SkipBvh build_skip_bvh(const Mesh& mesh);

/// Whether some of the mesh, whose hierarchy it is, lies more than `height_m` above the plane through a point. `normal` has
/// length 1.
bool reaches_above(const SkipBvh& bvh, const Mesh& mesh, const glm::vec3& point_m, const glm::vec3& normal, float height_m);

}  // namespace catchlight::render
