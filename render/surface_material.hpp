// A mesh's materials as shading takes them, in both renderers.
#pragma once

#include <vector>

#include "render/mesh/mesh.hpp"
#include "shaders/interface.h"

namespace catchlight::render {

struct SurfaceMaterials {
  std::vector<shader_interface::SurfaceMaterial> materials;  ///< in the mesh's order
  bool emits = false;                                        ///< some material is a light itself
  bool reflects = false;                                     ///< some material mirrors what is around it
};

SurfaceMaterials surface_materials(const Mesh& mesh);

}  // namespace catchlight::render
