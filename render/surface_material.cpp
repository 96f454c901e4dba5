#include "render/surface_material.hpp"

#include <algorithm>

namespace catchlight::render {

SurfaceMaterials surface_materials(const Mesh& mesh) {
  SurfaceMaterials result;
  for (const Material& material : mesh.materials) {
    // Where nothing is mirrored face on, nothing is at grazing angles: f90 follows f0 below 2 % (Lagarde & de Rousiers 2014).
    const float f90 = std::clamp(50.0f * material.dielectric_f0, 0.0f, 1.0f);
    result.materials.push_back({{material.base_color, material.metallic},
                                {material.emissive, material.roughness},
                                {material.dielectric_f0, f90, 0, 0},
                                {material.unlit_color, 0}});
    result.emits = result.emits || material.emissive != glm::vec3(0);
    result.reflects = result.reflects || material.metallic > 0 || material.dielectric_f0 > 0;
  }
  return result;
}

}  // namespace catchlight::render
