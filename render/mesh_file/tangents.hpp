// Tangents for normal maps.
#pragma once

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// Gives vertices of normal-mapped triangles that have no tangent (0) one as MikkTSpace does (Mikkelsen, "Simulation of Wrinkled
/// Surfaces Revisited", 2008): along u as it runs over the triangles around, each perpendicular to the vertex's normal and
/// weighted by its angle there. Triangles in which the picture is mirrored don't count for those in which it is not: vertices
/// between the two become two. Needs normals of length 1.
void make_missing_tangents(Mesh& mesh);

}  // namespace catchlight::render
