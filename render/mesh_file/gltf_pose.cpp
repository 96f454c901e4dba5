#include "render/mesh_file/gltf_pose.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "catchlight/error.hpp"

namespace catchlight::render::gltf {
namespace {

constexpr int kMaxDepth = 200;

/// Stands for nodes that no root leads to. No transform has a last row of zeros.
const glm::dmat4 kUnplaced(0);

[[noreturn]] void throw_circle(const Document& document) {
  throw Error(document.path + ": nodes are nested more than 200 deep or in a circle");
}

glm::dmat4 placed(const glm::dvec3& translation, const glm::dquat& rotation, const glm::dvec3& scale) {
  return glm::scale(glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(glm::normalize(rotation)), scale);
}

std::vector<float> attribute_of(const Document& document, const tinygltf::Primitive& primitive, const std::string& name,
                                int components) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? std::vector<float>() : read_floats(document, found->second, components);
}

void visit(const Document& document, int index, const glm::dmat4& scene_from_parent, int depth, std::vector<glm::dmat4>& result) {
  if (depth > kMaxDepth) throw_circle(document);
  const tinygltf::Node& node = document.model.nodes.at(index);
  result[index] = scene_from_parent * parent_from_node(node);
  for (const int child : node.children) visit(document, child, result[index], depth + 1, result);
}

/// Takes the mesh's frame, as it was bound, to the scene: one for each joint.
std::vector<glm::dmat4> scene_from_joints(const Document& document, const tinygltf::Skin& skin,
                                          const std::vector<glm::dmat4>& scene_from_nodes) {
  std::vector<float> inverse;
  if (skin.inverseBindMatrices >= 0) inverse = read_floats(document, skin.inverseBindMatrices, 16);
  std::vector<glm::dmat4> result;
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const bool has_inverse = 16 * (i + 1) <= inverse.size();
    result.push_back(scene_from_nodes.at(skin.joints[i]) *
                     (has_inverse ? glm::dmat4(glm::make_mat4(&inverse[16 * i])) : glm::dmat4(1)));
  }
  return result;
}

}  // namespace

glm::dmat4 parent_from_node(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  const auto vector = [](const std::vector<double>& v, double otherwise) {
    return v.size() == 3 ? glm::dvec3(v[0], v[1], v[2]) : glm::dvec3(otherwise);
  };
  const std::vector<double>& r = node.rotation;  // x y z w
  return placed(vector(node.translation, 0), r.size() == 4 ? glm::dquat(r[3], r[0], r[1], r[2]) : glm::dquat(1, 0, 0, 0),
                vector(node.scale, 1));
}

std::vector<glm::dmat4> scene_from_nodes(const Document& document) {
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  std::vector<bool> is_child(nodes.size());
  for (const tinygltf::Node& node : nodes)
    for (const int child : node.children) is_child.at(child) = true;
  std::vector<glm::dmat4> result(nodes.size(), kUnplaced);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!is_child[i]) visit(document, static_cast<int>(i), glm::dmat4(1), 0, result);
  if (std::find(result.begin(), result.end(), kUnplaced) != result.end()) throw_circle(document);
  return result;
}

std::vector<glm::dmat4> scene_from_instances(const Document& document, const tinygltf::Node& node,
                                             const glm::dmat4& scene_from_node) {
  const tinygltf::Value* instancing = extension(node.extensions, "EXT_mesh_gpu_instancing");
  if (!instancing || !instancing->Has("attributes")) return {scene_from_node};
  const tinygltf::Value& attributes = instancing->Get("attributes");
  const auto read = [&](const char* name, int components) {
    const int accessor = whole_number(&attributes, name, -1);
    return accessor < 0 ? std::vector<float>() : read_floats(document, accessor, components);
  };
  const std::vector<float> translation = read("TRANSLATION", 3), rotation = read("ROTATION", 4), scale = read("SCALE", 3);
  const std::size_t count = std::max({translation.size() / 3, rotation.size() / 4, scale.size() / 3});
  std::vector<glm::dmat4> result;
  for (std::size_t i = 0; i < count; ++i) {
    const auto vector = [i](const std::vector<float>& v, double otherwise) {
      return 3 * i + 2 < v.size() ? glm::dvec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]) : glm::dvec3(otherwise);
    };
    const float* r = 4 * i + 3 < rotation.size() ? &rotation[4 * i] : nullptr;
    result.push_back(scene_from_node * placed(vector(translation, 0),
                                              r ? glm::dquat(r[3], r[0], r[1], r[2]) : glm::dquat(1, 0, 0, 0), vector(scale, 1)));
  }
  return result;
}

std::vector<glm::dmat4> scene_from_skinned(const Document& document, const tinygltf::Node& node,
                                           const tinygltf::Primitive& primitive,
                                           const std::vector<glm::dmat4>& scene_from_nodes) {
  if (node.skin < 0 || !primitive.attributes.contains("JOINTS_0")) return {};
  const std::vector<glm::dmat4> joints = scene_from_joints(document, document.model.skins.at(node.skin), scene_from_nodes);
  std::vector<glm::dmat4> result;
  std::vector<double> sums;
  for (const char* set : {"0", "1"}) {
    const std::vector<float> indices = attribute_of(document, primitive, std::string("JOINTS_") + set, 4),
                             weights = attribute_of(document, primitive, std::string("WEIGHTS_") + set, 4);
    const std::size_t count = std::min(indices.size(), weights.size()) / 4;
    if (result.size() < count) result.resize(count, glm::dmat4(0)), sums.resize(count);
    for (std::size_t i = 0; i < 4 * count; ++i) {
      if (weights[i] == 0) continue;
      if (!(indices[i] >= 0 && indices[i] < static_cast<float>(joints.size())))
        throw Error(document.path + ": damaged glTF: a vertex hangs on a joint that its skin does not have");
      result[i / 4] += static_cast<double>(weights[i]) * joints.at(static_cast<std::size_t>(indices[i]));
      sums[i / 4] += static_cast<double>(weights[i]);
    }
  }
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = sums[i] > 0 ? result[i] / sums[i] : glm::dmat4(1);
  return result;
}

void add_morph_targets(const Document& document, const tinygltf::Node& node, const tinygltf::Primitive& primitive,
                       const std::string& attribute, int components, std::vector<float>& values) {
  const std::vector<double>& weights = node.weights.empty() ? document.model.meshes.at(node.mesh).weights : node.weights;
  for (std::size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
    const auto found = primitive.targets[t].find(attribute);
    if (weights[t] == 0 || found == primitive.targets[t].end()) continue;
    const std::vector<float> target = read_floats(document, found->second, components);
    for (std::size_t i = 0; i < std::min(target.size(), values.size()); ++i)
      values[i] += static_cast<float>(weights[t]) * target[i];
  }
}

}  // namespace catchlight::render::gltf
