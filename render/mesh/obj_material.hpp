// Wavefront's material libraries, which OBJ files name.
#pragma once

#include <string>
#include <vector>

#include "render/mesh/mesh.hpp"
#include "render/mesh/unused_features.hpp"

namespace catchlight::render {

/// The material of faces that name none.
Material obj_default_material();

/// The materials of a library: Kd is the base colour; the width of the highlight, Ns, gives the roughness; without Ks nothing is
/// reflected. Pr and Pm, which Blender writes for roughness and metalness, go before. Throws Error naming file and line.
std::vector<Material> read_obj_materials(const std::string& path, UnusedFeatures& unused);

}  // namespace catchlight::render
