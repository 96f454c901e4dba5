// Base colours at a mesh's vertices.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// Each vertex's base colour: the material's times the vertex's times the texture's mean over the vertex's surroundings, which
/// reach half the way to its neighbours. Black where the material is unlit, or no triangle has the vertex.
std::vector<glm::vec3> vertex_base_colors(const Mesh& mesh);

/// The part of it that a vertex sends back of diffuse light: metals send none.
std::vector<glm::vec3> vertex_diffuse_albedos(const Mesh& mesh);

/// Multiplies base colour textures into the vertices' colours, for renderers that draw no textures, and removes all textures.
/// Albedo then varies as finely as the vertices.
void fold_base_color_textures(Mesh& mesh);

}  // namespace catchlight::render
