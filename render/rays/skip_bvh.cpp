#include "render/rays/skip_bvh.hpp"

#include <embree3/rtcore.h>

#include <memory>
#include <new>
#include <span>

#include "catchlight/error.hpp"
#include "render/mesh/bounds.hpp"

namespace catchlight::render {
namespace {

constexpr unsigned kLeafTriangles = 4;

/// What Embree's builder makes; lives in its thread-local memory.
struct BuildNode {
  BuildNode* children[2] = {};
  std::uint32_t primitives[kLeafTriangles] = {};
  unsigned count = 0;  ///< primitives of a leaf; 0: an inner node
};

BuildNode* make_node(RTCThreadLocalAllocator allocator) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
}

void* create_inner(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return make_node(allocator);
}

void set_children(void* node, void** children, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i) static_cast<BuildNode*>(node)->children[i] = static_cast<BuildNode*>(children[i]);
}

void set_bounds(void*, const RTCBounds**, unsigned, void*) {}  // flatten() has them from the triangles

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
  BuildNode* leaf = make_node(allocator);
  leaf->count = static_cast<unsigned>(count);
  for (std::size_t i = 0; i < count; ++i) leaf->primitives[i] = primitives[i].primID;
  return leaf;
}

/// Appends the node and all below it, depth first. Boxes are taken from the triangles themselves.
Bounds flatten(const BuildNode& node, const Mesh& mesh, SkipBvh& bvh) {
  const std::size_t index = bvh.nodes.size();
  bvh.nodes.emplace_back();
  Bounds bounds;
  std::uint32_t triangles = 0;
  if (node.count > 0) {
    triangles = static_cast<std::uint32_t>(bvh.triangles.size()) * 8 + node.count;
    for (const std::uint32_t triangle : std::span(node.primitives, node.count)) {
      bvh.triangles.push_back(triangle);
      bounds.add(triangle_bounds(mesh, triangle));
    }
  } else {
    for (const BuildNode* child : node.children)
      if (child) bounds.add(flatten(*child, mesh, bvh));
  }
  bvh.nodes[index] = {bounds.min_m, triangles, bounds.max_m, static_cast<std::uint32_t>(bvh.nodes.size())};
  return bounds;
}

std::vector<RTCBuildPrimitive> primitives_of(const Mesh& mesh) {
  std::vector<RTCBuildPrimitive> primitives(mesh.indices.size() / 3);
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const Bounds bounds = triangle_bounds(mesh, i);
    primitives[i] = {bounds.min_m.x, bounds.min_m.y, bounds.min_m.z, 0,
                     bounds.max_m.x, bounds.max_m.y, bounds.max_m.z, static_cast<unsigned>(i)};
  }
  return primitives;
}

}  // namespace

SkipBvh build_skip_bvh(const Mesh& mesh) {
  SkipBvh result;
  std::vector<RTCBuildPrimitive> primitives = primitives_of(mesh);
  if (primitives.empty()) return result;
  const std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device(rtcNewDevice("threads=1"), rtcReleaseDevice);
  const std::unique_ptr<RTCBVHTy, void (*)(RTCBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.bvh = bvh.get();
  arguments.maxLeafSize = kLeafTriangles;
  arguments.primitives = primitives.data();
  arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = create_inner;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  const auto* root = static_cast<const BuildNode*>(rtcBuildBVH(&arguments));
  if (!root) throw Error("no memory for the hierarchy of " + std::to_string(primitives.size()) + " triangles");
  flatten(*root, mesh, result);
  return result;
}

bool reaches_above(const SkipBvh& bvh, const Mesh& mesh, const glm::vec3& point_m, const glm::vec3& normal, float height_m) {
  const auto is_above = [&](const glm::vec3& place_m) { return glm::dot(place_m - point_m, normal) > height_m; };
  for (std::size_t i = 0; i < bvh.nodes.size();) {
    const SkipNode& node = bvh.nodes[i];
    if (!is_above(glm::mix(node.min_m, node.max_m, glm::greaterThan(normal, glm::vec3(0))))) {
      i = node.skip;
      continue;
    }
    for (std::uint32_t t = node.triangles >> 3; t < (node.triangles >> 3) + (node.triangles & 7); ++t) {
      const std::uint32_t* corner = &mesh.indices[3 * static_cast<std::size_t>(bvh.triangles[t])];
      for (int k = 0; k < 3; ++k)
        if (is_above(mesh.vertices[corner[k]].position_m)) return true;
    }
    ++i;
  }
  return false;
}

}  // namespace catchlight::render
