// Meshes read from files.
#pragma once

#include <string>
#include <vector>

#include "catchlight/error.hpp"
#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// Reads glTF 2.0 (.glb, .gltf) with node transforms applied, OBJ and PLY. Units are metres. Makes normals where the file has
/// none: flat ones, but smooth ones where OBJ's smoothing groups say so, and where PLY bends little. Normal maps get
/// tangents where the file has none. Triangles without area are left out with a
/// warning. Throws Error naming the file: unreadable, no triangles, non-finite positions, indices out of range, an unknown
/// required extension.
Mesh load_mesh(const std::string& path, const WarningHandler& warn);

/// The files that load_mesh reads for that one: itself first, then those that it names (glTF's buffers and textures, OBJ's
/// material libraries). A file that cannot be read names none.
std::vector<std::string> files_of_mesh(const std::string& path);

}  // namespace catchlight::render
