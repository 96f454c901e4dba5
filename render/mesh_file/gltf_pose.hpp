// Where glTF's vertices are at rest: nodes, instances, skins and morph targets.
#pragma once

#include "render/mesh_file/gltf.hpp"

namespace catchlight::render::gltf {

/// Takes the node's frame to its parent's.
glm::dmat4 parent_from_node(const tinygltf::Node& node);

/// Takes each node's frame to the scene's, whether the scene shows it or not. Throws Error where nodes are nested too deep or in
/// a circle.
std::vector<glm::dmat4> scene_from_nodes(const Document& document);

/// The frames in which the node's mesh is drawn, each to the scene's: its own, or those of its instances
/// (EXT_mesh_gpu_instancing).
std::vector<glm::dmat4> scene_from_instances(const Document& document, const tinygltf::Node& node,
                                             const glm::dmat4& scene_from_node);

/// Takes each vertex of a skinned primitive to the scene: the blend of its joints, whatever frame its own node has. Empty where
/// the primitive is not skinned.
std::vector<glm::dmat4> scene_from_skinned(const Document& document, const tinygltf::Node& node,
                                           const tinygltf::Primitive& primitive, const std::vector<glm::dmat4>& scene_from_nodes);

/// Adds the primitive's morph targets for an attribute by the weights of the node, or else of its mesh, to its values.
void add_morph_targets(const Document& document, const tinygltf::Node& node, const tinygltf::Primitive& primitive,
                       const std::string& attribute, int components, std::vector<float>& values);

}  // namespace catchlight::render::gltf
