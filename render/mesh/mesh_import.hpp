// Readers behind load_mesh: what the file says, not yet checked. A zero normal stands for a missing one.
#pragma once

#include "catchlight/error.hpp"
#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// Reads glTF 2.0, text or binary.
Mesh import_gltf(const std::string& path, const WarningHandler& warn);

/// Reads OBJ and PLY.
Mesh import_with_assimp(const std::string& path);

}  // namespace catchlight::render
