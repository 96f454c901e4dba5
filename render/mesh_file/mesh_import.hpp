// Readers behind load_mesh: what the file says, not yet checked.
#pragma once

#include "catchlight/error.hpp"
#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// A mesh as its file has it. A normal of zero stands for a missing one; where some are missing, the rest says what is smooth.
struct ImportedMesh {
  Mesh mesh;
  std::vector<std::uint32_t> smoothing_group;  ///< of each triangle, or empty; neighbours of one group, but for 0, are smooth
  double smooth_below_deg = 0;                 ///< neighbours that meet at a smaller angle are smooth; 0: only coplanar ones
};

/// Reads glTF 2.0, text or binary. It is flat where it has no normals, as its standard demands.
ImportedMesh import_gltf(const std::string& path, const WarningHandler& warn);

/// Reads Wavefront's OBJ with its material libraries. It is flat where it has neither normals nor smoothing groups.
ImportedMesh import_obj(const std::string& path, const WarningHandler& warn);

/// Reads PLY. Scans mostly come without normals, so that what bends little counts as smooth.
ImportedMesh import_ply(const std::string& path, const WarningHandler& warn);

/// Gives each corner without a normal that of the smooth surface around it: faces count by area and by their angle there (Max,
/// "Weights for Computing Vertex Normals", 1999, and Thuermer & Wuethrich 1998), so that it does not depend on how the surface
/// is cut into triangles. Vertices at which surfaces meet in an edge become several. Needs triangles with an area.
void make_missing_normals(ImportedMesh& imported);

/// Appends the triangles of a polygon's corners, of which `position_m` are the places: the corners' numbers, three by three.
/// Concave polygons are cut rightly where they are flat and do not cross themselves.
void triangulate(const std::vector<glm::dvec3>& position_m, std::vector<std::uint32_t>& corners);

}  // namespace catchlight::render
