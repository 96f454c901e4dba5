// Where glTF's vertices are at rest, and materials of older exporters.
#include "tests/render/mesh_file/gltf_text.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace catchlight::render {
namespace {

using testing::IsEmpty;

/// The triangle, bound to one joint: node 1.
Gltf skinned(const std::string& nodes, const std::vector<float>& inverse_bind) {
  Gltf gltf = triangle();
  const int joints =
      gltf.accessor(R"("bufferView":)" + std::to_string(gltf.view(bytes_of<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}))) +
                    R"(,"componentType":5121,"type":"VEC4","count":3)");
  const int weights = gltf.vectors({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  const int inverse = gltf.vectors(inverse_bind, "MAT4", 16);
  gltf.primitive =
      R"("attributes":{"POSITION":0,"JOINTS_0":)" + std::to_string(joints) + R"(,"WEIGHTS_0":)" + std::to_string(weights) + "}";
  gltf.nodes = nodes;
  gltf.extra = R"("skins":[{"joints":[1],"inverseBindMatrices":)" + std::to_string(inverse) + "}],";
  return gltf;
}

const std::vector<float> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

class GltfPose : public GltfFile {};

TEST_F(GltfPose, JointsMoveTheirVertices) {
  std::vector<float> inverse = kIdentity;
  inverse[12] = -1;  // bound at x = 1
  const Mesh mesh = load(skinned(R"({"mesh":0,"skin":0,"children":[1]},)"
                                 R"({"translation":[5,0,0],"rotation":[0,0,0.70710678,0.70710678]})",
                                 inverse));
  EXPECT_LT(glm::distance(mesh.vertices[1].position_m, glm::vec3(5, 0, 0)), 1e-5f) << "the joint's own place";
  EXPECT_LT(glm::distance(mesh.vertices[0].position_m, glm::vec3(5, -1, 0)), 1e-5f);
  EXPECT_THAT(warnings_.all, IsEmpty());
}

TEST_F(GltfPose, ASkinnedMeshsOwnNodeDoesNotCount) {
  const Mesh mesh = load(skinned(R"({"mesh":0,"skin":0,"scale":[3,3,3],"translation":[9,0,0]},{})", kIdentity));
  EXPECT_EQ(mesh.vertices[0].position_m, glm::vec3(0));
  EXPECT_EQ(mesh.vertices[1].position_m, glm::vec3(1, 0, 0));
}

TEST_F(GltfPose, JointsThatMirrorKeepTheOutside) {
  const Mesh mesh = load(skinned(R"({"mesh":0,"skin":0},{"scale":[-1,1,1]})", kIdentity));
  const auto corner = [&](int k) { return mesh.vertices[mesh.indices[k]].position_m; };
  EXPECT_GT(glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z, 0);
}

TEST_F(GltfPose, JointsThatAreNotThereAreRefused) {
  Gltf gltf = skinned(R"({"mesh":0,"skin":0},{})", kIdentity);
  gltf.extra = R"("skins":[{"joints":[7]}],)";
  EXPECT_NE(load_error(gltf).find("damaged glTF"), std::string::npos);
}

TEST_F(GltfPose, VerticesOnJointsThatTheSkinDoesNotHaveAreRefused) {
  Gltf gltf = skinned(R"({"mesh":0,"skin":0},{})", kIdentity);
  gltf.extra = R"("skins":[{"joints":[]}],)";
  EXPECT_NE(load_error(gltf).find("a joint that its skin does not have"), std::string::npos);
}

TEST_F(GltfPose, MorphTargetsCountByTheirWeights) {
  Gltf gltf = triangle();
  const int target = gltf.vectors({0, 0, 2, 0, 0, 2, 0, 0, 4}, "VEC3", 3);
  gltf.primitive += R"(,"targets":[{"POSITION":)" + std::to_string(target) + "}]";
  gltf.nodes = R"({"mesh":0,"weights":[0.5]})";
  const Mesh mesh = load(gltf);
  EXPECT_EQ(mesh.vertices[0].position_m, glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.vertices[2].position_m, glm::vec3(0, 1, 2));
  EXPECT_THAT(warnings_.all, IsEmpty());
}

TEST_F(GltfPose, InstancesAreDrawnEach) {
  Gltf gltf = triangle();
  const int translation = gltf.vectors({1, 0, 0, 0, 5, 0}, "VEC3", 3), scale = gltf.vectors({1, 1, 1, 2, 2, 2}, "VEC3", 3);
  gltf.nodes = R"({"mesh":0,"translation":[0,0,1],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
               std::to_string(translation) + R"(,"SCALE":)" + std::to_string(scale) + "}}}}";
  gltf.extra = R"("extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"],)";
  const Mesh mesh = load(gltf);
  ASSERT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.vertices[1].position_m, glm::vec3(2, 0, 1));
  EXPECT_EQ(mesh.vertices[4].position_m, glm::vec3(2, 5, 1));
  EXPECT_THAT(warnings_.all, IsEmpty());
}

TEST_F(GltfPose, SpecularGlossinessIsConverted) {
  const auto converted = [&](const std::string& factors) {
    Gltf gltf = triangle();
    gltf.primitive += R"(,"material":0)";
    gltf.materials = R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{)" + factors + "}}}";
    gltf.extra = R"("extensionsUsed":["KHR_materials_pbrSpecularGlossiness"],)";
    return load(gltf).materials.at(0);
  };
  const Material plastic =
      converted(R"("diffuseFactor":[0.05,0.5,0.05,1],"specularFactor":[0.04,0.04,0.04],"glossinessFactor":0.2)");
  EXPECT_NEAR(plastic.metallic, 0, 1e-6);
  EXPECT_LT(glm::distance(plastic.base_color, glm::vec3(0.05f, 0.5f, 0.05f)), 1e-5f);
  EXPECT_NEAR(plastic.roughness, 0.8, 1e-6);
  EXPECT_NEAR(plastic.dielectric_f0, 0.04, 1e-6);
  const Material gold = converted(R"("diffuseFactor":[0,0,0,1],"specularFactor":[1,0.77,0.34],"glossinessFactor":0.9)");
  EXPECT_NEAR(gold.metallic, 1, 1e-6);
  EXPECT_LT(glm::distance(gold.base_color, glm::vec3(1, 0.77f, 0.34f)), 1e-5f);
  EXPECT_THAT(warnings_.all, IsEmpty());
}

}  // namespace
}  // namespace catchlight::render
