#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>

#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "render/mesh/mesh_import.hpp"

namespace catchlight::render {
namespace {

glm::vec3 vec3(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}
glm::vec3 vec3(const aiColor3D& c) {
  return {c.r, c.g, c.b};
}

// Wavefront's Phong material: Kd is the base colour; the width of its highlight gives the roughness (Blinn-Phong exponent
// s = 2 / alpha^2 - 2); without Ks nothing is reflected.
Material material_of(const aiMaterial& source) {
  Material material;
  aiString name;
  if (source.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
  aiColor3D color;
  if (source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS) material.base_color = glm::clamp(vec3(color), 0.0f, 1.0f);
  if (source.Get(AI_MATKEY_COLOR_EMISSIVE, color) == AI_SUCCESS) material.emissive = glm::max(vec3(color), 0.0f);
  float exponent = 0;
  if (source.Get(AI_MATKEY_SHININESS, exponent) == AI_SUCCESS && exponent > 0) {
    material.roughness = std::pow(2.0f / (exponent + 2.0f), 0.25f);
  }
  if (source.Get(AI_MATKEY_COLOR_SPECULAR, color) == AI_SUCCESS && color.IsBlack()) material.dielectric_f0 = 0.0f;
  return material;
}

// 8-bit vertex colours are meant for display, so they are decoded; white stays white.
glm::vec3 linear_color(const aiColor4D& code) {
  return {linear_from_srgb(code.r), linear_from_srgb(code.g), linear_from_srgb(code.b)};
}

void append_part(Mesh& mesh, const aiMesh& part) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    Vertex vertex{vec3(part.mVertices[i]), glm::vec3(0)};
    if (part.HasNormals()) vertex.normal = vec3(part.mNormals[i]);
    if (part.HasVertexColors(0)) vertex.color = linear_color(part.mColors[0][i]);
    mesh.vertices.push_back(vertex);
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;
    for (unsigned k = 0; k < 3; ++k) mesh.indices.push_back(base + face.mIndices[k]);
    mesh.triangle_material.push_back(static_cast<std::uint16_t>(part.mMaterialIndex));
  }
}

}  // namespace

Mesh import_with_assimp(const std::string& path) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices);
  if (!scene) throw Error(path + ": cannot be read as a mesh of triangles: " + importer.GetErrorString());
  if (scene->mNumMaterials > 65536) throw Error(path + ": more than 65536 materials");
  Mesh mesh;
  for (unsigned i = 0; i < scene->mNumMaterials; ++i) mesh.materials.push_back(material_of(*scene->mMaterials[i]));
  if (mesh.materials.empty()) mesh.materials.emplace_back();
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) append_part(mesh, *scene->mMeshes[i]);
  return mesh;
}

}  // namespace catchlight::render
