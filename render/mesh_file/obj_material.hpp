// Wavefront's material libraries, which OBJ files name.
#pragma once

#include <string>
#include <vector>

#include "render/mesh/mesh.hpp"
#include "render/mesh_file/texture_file.hpp"
#include "render/mesh_file/unused_features.hpp"

namespace catchlight::render {

/// The material of faces that name none.
Material obj_default_material();

/// The materials of a library: Kd is the base colour, times map_Kd; the width of the highlight, Ns, gives the roughness; without
/// Ks nothing is reflected. Pr and Pm, which Blender writes for roughness and metalness, go before. norm is a normal map, and so
/// is bump where its picture is one. Textures that are not there or cannot be decoded are left out with a warning. Throws Error
/// naming file and line.
std::vector<Material> read_obj_materials(const std::string& path, TextureList& textures, UnusedFeatures& unused,
                                         const WarningHandler& warn);

/// The pictures that a library names.
std::vector<std::string> pictures_of_obj_materials(const std::string& path);

}  // namespace catchlight::render
