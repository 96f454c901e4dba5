// Rays against the object in the tag frame: render/rays/skip_bvh.hpp's hierarchy, walked without a stack.
#include "vertices.glsl"

struct BvhNode {
  vec3 min_m;
  uint triangles;  // first * 8 + count; count 0: an inner node
  vec3 max_m;
  uint skip;
};
layout(std430, binding = BINDING_BVH_NODES) readonly buffer BvhNodeBlock { BvhNode bvh_nodes[]; };
layout(std430, binding = BINDING_BVH_TRIANGLES) readonly buffer BvhTriangleBlock { uvec4 bvh_triangles[]; };  // corners, material

struct RayHit {
  uvec4 triangle;  // corners, material
  float distance_m;
  vec2 weights;  // barycentric weights of corners 1 and 2
};

// Both faces count but for back faces closer than `skin_m`: those are the surface that the ray starts from, whose smoothed normals
// let it dip below its triangles.
void intersect_triangle(uvec4 triangle, vec3 origin, vec3 direction, float skin_m, inout RayHit nearest) {
  vec3 a = vertex_vec3(triangle.x, 0u), edge1 = vertex_vec3(triangle.y, 0u) - a, edge2 = vertex_vec3(triangle.z, 0u) - a;
  vec3 p = cross(direction, edge2);
  float determinant = dot(edge1, p);
  if (determinant == 0.0) return;
  vec3 from_a = (origin - a) / determinant, q = cross(from_a, edge1);
  vec2 weights = vec2(dot(from_a, p), dot(direction, q));
  float distance_m = dot(edge2, q);
  bool inside = all(greaterThanEqual(weights, vec2(0.0))) && weights.x + weights.y <= 1.0;
  if (!inside || distance_m <= (determinant < 0.0 ? skin_m : 0.0) || distance_m >= nearest.distance_m) return;
  nearest = RayHit(triangle, distance_m, weights);
}

// The nearest hit before nearest.distance_m, which stays where there is none.
void trace(vec3 origin, vec3 direction, float skin_m, inout RayHit nearest) {
  vec3 inverse_direction = 1.0 / direction;
  uint count = uint(bvh_nodes.length());
  for (uint i = 0u; i < count;) {
    BvhNode node = bvh_nodes[i];
    vec3 to_min = (node.min_m - origin) * inverse_direction, to_max = (node.max_m - origin) * inverse_direction;
    vec3 near = min(to_min, to_max), far = max(to_min, to_max);
    float enters = max(max(near.x, near.y), max(near.z, 0.0)), leaves = min(min(far.x, far.y), min(far.z, nearest.distance_m));
    if (!(enters <= leaves)) {
      i = node.skip;
      continue;
    }
    uint first = node.triangles >> 3, last = first + (node.triangles & 7u);
    for (uint t = first; t < last; ++t) intersect_triangle(bvh_triangles[t], origin, direction, skin_m, nearest);
    ++i;
  }
}
