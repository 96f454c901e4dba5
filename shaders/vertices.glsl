// The object's vertices as a buffer has them: position, normal, colour.
layout(std430, binding = BINDING_VERTICES) readonly buffer VertexBlock { float vertex_floats[]; };

vec3 vertex_vec3(uint vertex, uint member) {
  uint at = 9u * vertex + 3u * member;
  return vec3(vertex_floats[at], vertex_floats[at + 1u], vertex_floats[at + 2u]);
}

vec3 unit(vec3 v) { return v / max(length(v), 1e-20); }
