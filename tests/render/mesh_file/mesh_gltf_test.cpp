// What is read of glTF files, made by hand, and what is refused.
#include "catchlight/color.hpp"
#include "render/mesh/base_color.hpp"
#include "render/mesh_file/mesh_file.hpp"
#include "tests/render/mesh_file/gltf_text.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace catchlight::render {
namespace {

TEST_F(GltfFile, TriangleWithoutNormalsOrMaterialGetsBoth) {
  const Mesh mesh = load(triangle());
  ASSERT_EQ(mesh.vertices.size(), 3u);
  for (const Vertex& vertex : mesh.vertices) EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  ASSERT_EQ(mesh.materials.size(), 1u);
  EXPECT_EQ(mesh.materials[0].base_color, glm::vec3(1)) << "glTF's default material";
  EXPECT_EQ(mesh.materials[0].metallic, 1);
}

TEST_F(GltfFile, NodesMultiplyDownTheTree) {
  Gltf gltf = triangle();
  gltf.nodes = R"({"translation":[10,0,0],"children":[1]},{"rotation":[0,0,0.70710678,0.70710678],"scale":[2,3,4],"mesh":0})";
  const Mesh mesh = load(gltf);
  EXPECT_LT(glm::distance(mesh.vertices[1].position_m, glm::vec3(10, 2, 0)), 1e-5f);
  EXPECT_LT(glm::distance(mesh.vertices[2].position_m, glm::vec3(7, 0, 0)), 1e-5f);
}

TEST_F(GltfFile, MatrixNodesAreColumnMajor) {
  Gltf gltf = triangle();
  gltf.nodes = R"({"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 5,6,7,1],"mesh":0})";
  EXPECT_LT(glm::distance(load(gltf).vertices[1].position_m, glm::vec3(5, 7, 7)), 1e-6f);
}

TEST_F(GltfFile, MirroredNodesKeepTheirOutside) {
  Gltf gltf = triangle();
  gltf.nodes = R"({"scale":[-1,1,1],"mesh":0})";
  const Mesh mesh = load(gltf);
  const auto corner = [&](int k) { return mesh.vertices[mesh.indices[k]].position_m; };
  EXPECT_GT(glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z, 0);
  EXPECT_EQ(mesh.vertices[0].normal, glm::vec3(0, 0, 1));
}

TEST_F(GltfFile, NormalsOfScaledNodesStayPerpendicular) {
  Gltf gltf;
  const int positions = gltf.vectors({0, 0, 0, 1, 0, 1, 0, 1, 0}, "VEC3", 3);
  const float s = std::sqrt(0.5f);
  gltf.primitive = R"("attributes":{"POSITION":)" + std::to_string(positions) + R"(,"NORMAL":)" +
                   std::to_string(gltf.vectors({-s, 0, s, -s, 0, s, -s, 0, s}, "VEC3", 3)) + "}";
  gltf.nodes = R"({"scale":[3,1,1],"mesh":0})";
  const Mesh mesh = load(gltf);
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(glm::dot(vertex.normal, mesh.vertices[1].position_m - mesh.vertices[0].position_m), 0, 1e-6);
    EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-6);
  }
}

TEST_F(GltfFile, NodesInACircleAreRefused) {
  Gltf gltf = triangle();
  gltf.nodes = R"({"children":[1]},{"children":[0],"mesh":0})";
  EXPECT_NE(load_error(gltf), "");
}

TEST_F(GltfFile, IndicesOfEveryWidth) {
  const auto with_indices = [](const std::vector<unsigned char>& bytes, int type) {
    Gltf gltf = triangle();
    gltf.primitive += R"(,"indices":)" + std::to_string(gltf.accessor(R"("bufferView":)" + std::to_string(gltf.view(bytes)) +
                                                                      R"(,"componentType":)" + std::to_string(type) +
                                                                      R"(,"type":"SCALAR","count":3)"));
    return gltf;
  };
  const std::vector<std::uint32_t> expected{2, 0, 1};
  EXPECT_EQ(load(with_indices(bytes_of<std::uint8_t>({2, 0, 1}), 5121)).indices, expected);
  EXPECT_EQ(load(with_indices(bytes_of<std::uint16_t>({2, 0, 1}), 5123)).indices, expected);
  EXPECT_EQ(load(with_indices(bytes_of<std::uint32_t>({2, 0, 1}), 5125)).indices, expected);
  EXPECT_NE(load_error(with_indices(bytes_of<std::uint8_t>({2, 0, 9}), 5121)).find("vertex 9 of 3"), std::string::npos);
}

TEST_F(GltfFile, StripsAndFansKeepTheirWinding) {
  for (const auto& [mode, order] : {std::pair(5, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}),
                                    std::pair(6, std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})}) {
    Gltf gltf;
    gltf.primitive = R"("mode":)" + std::to_string(mode) + R"(,"attributes":{"POSITION":)" +
                     std::to_string(gltf.vectors(order, "VEC3", 3)) + "}";
    const Mesh mesh = load(gltf);
    ASSERT_EQ(mesh.indices.size(), 6u);
    float area = 0;
    for (int t = 0; t < 2; ++t) {
      const auto corner = [&](int k) { return mesh.vertices[mesh.indices[3 * t + k]].position_m; };
      const float z = glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z;
      EXPECT_GT(z, 0) << "mode " << mode << ", triangle " << t;
      area += z / 2;
    }
    EXPECT_FLOAT_EQ(area, 1);
  }
}

TEST_F(GltfFile, PointsAreLeftOutAndThenNothingIsLeft) {
  Gltf gltf = triangle();
  gltf.primitive += R"(,"mode":0)";
  EXPECT_NE(load_error(gltf).find("no triangles"), std::string::npos);
  EXPECT_EQ(warnings_.all.size(), 1u);
}

TEST_F(GltfFile, InterleavedAndNormalizedAttributes) {
  // Position as floats, colour as normalised bytes, one after the other: stride 16.
  Gltf gltf;
  std::vector<unsigned char> bytes;
  for (int v = 0; v < 3; ++v) {
    const auto position = bytes_of(std::vector<float>(kTriangle.begin() + 3 * v, kTriangle.begin() + 3 * v + 3));
    bytes.insert(bytes.end(), position.begin(), position.end());
    bytes.insert(bytes.end(), {255, 51, 0, 255});
  }
  const std::string view = std::to_string(gltf.view(bytes, 16));
  gltf.accessor(R"("bufferView":)" + view + R"(,"componentType":5126,"type":"VEC3","count":3)");
  gltf.accessor(R"("bufferView":)" + view + R"(,"byteOffset":12,"componentType":5121,"normalized":true,"type":"VEC4","count":3)");
  gltf.primitive = R"("attributes":{"POSITION":0,"COLOR_0":1})";
  const Mesh mesh = load(gltf);
  EXPECT_EQ(mesh.vertices[2].position_m, glm::vec3(0, 1, 0));
  for (const Vertex& vertex : mesh.vertices)
    EXPECT_LT(glm::distance(vertex.color, glm::vec3(1, 0.2f, 0)), 1e-6f) << "linear, not sRGB";
}

TEST_F(GltfFile, QuantizedPositions) {
  Gltf gltf;
  gltf.accessor(R"("bufferView":)" +
                std::to_string(gltf.view(bytes_of<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0}), 8)) +
                R"(,"componentType":5122,"normalized":true,"type":"VEC3","count":3)");
  gltf.primitive = R"("attributes":{"POSITION":0})";
  gltf.extra = R"("extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],)";
  const Mesh mesh = load(gltf);
  EXPECT_EQ(mesh.vertices[1].position_m, glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.vertices[2].position_m, glm::vec3(0, -1, 0));
}

TEST_F(GltfFile, SparseAccessorsReplaceElements) {
  Gltf gltf;
  const int view = gltf.view(bytes_of(kTriangle));
  const int indices = gltf.view(bytes_of<std::uint16_t>({1}));
  const int values = gltf.view(bytes_of<float>({7, 0, 0}));
  gltf.accessor(R"("bufferView":)" + std::to_string(view) +
                R"(,"componentType":5126,"type":"VEC3","count":3,"sparse":{"count":1,"indices":{"bufferView":)" +
                std::to_string(indices) + R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(values) + "}}");
  gltf.primitive = R"("attributes":{"POSITION":0})";
  EXPECT_EQ(load(gltf).vertices[1].position_m, glm::vec3(7, 0, 0));
}

TEST_F(GltfFile, AccessorsBeyondTheirBufferAreRefused) {
  for (const char* fields :
       {R"("bufferView":0,"componentType":5126,"type":"VEC3","count":4)",
        R"("bufferView":0,"byteOffset":4,"componentType":5126,"type":"VEC3","count":3)",
        R"("bufferView":0,"componentType":5126,"type":"VEC3","count":400000000000)",
        R"("bufferView":7,"componentType":5126,"type":"VEC3","count":3)", R"("componentType":5126,"type":"VEC3","count":3)",
        R"("bufferView":0,"componentType":5126,"type":"VEC2","count":3)"}) {
    Gltf gltf;
    gltf.view(bytes_of(kTriangle));
    gltf.accessor(fields);
    gltf.primitive = R"("attributes":{"POSITION":0})";
    EXPECT_NE(load_error(gltf).find("a.gltf"), std::string::npos) << fields;
  }
}

TEST_F(GltfFile, MaterialExtensions) {
  Gltf gltf = triangle();
  gltf.primitive += R"(,"material":0)";
  gltf.materials =
      R"({"name":"glass","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1],"metallicFactor":0.25,"roughnessFactor":0.5},
    "emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_ior":{"ior":2.0},"KHR_materials_specular":{"specularFactor":0.5},
    "KHR_materials_emissive_strength":{"emissiveStrength":4.0}}})";
  const Material material = load(gltf).materials.at(0);
  EXPECT_EQ(material.name, "glass");
  EXPECT_LT(glm::distance(material.base_color, glm::vec3(0.1f, 0.2f, 0.3f)), 1e-6f);
  EXPECT_FLOAT_EQ(material.metallic, 0.25f);
  EXPECT_FLOAT_EQ(material.roughness, 0.5f);
  EXPECT_NEAR(material.dielectric_f0, 0.5 / 9, 1e-6);
  EXPECT_EQ(material.emissive, glm::vec3(4, 2, 0));
}

TEST_F(GltfFile, UnlitMaterialsShowTheirBaseColourAndNothingElse) {
  Gltf gltf = triangle();
  gltf.primitive += R"(,"material":0)";
  gltf.materials =
      R"({"name":"label","pbrMetallicRoughness":{"baseColorFactor":[1,0.02,0.3,1],"metallicFactor":1,"roughnessFactor":0.1},
    "emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_unlit":{}}})";
  const Material material = load(gltf).materials.at(0);
  EXPECT_EQ(material.name, "label");
  EXPECT_LT(glm::distance(material.unlit_color, glm::vec3(1, 0.02f, 0.3f)), 1e-6f);
  EXPECT_EQ(material.base_color, glm::vec3(0)) << "takes no light";
  EXPECT_EQ(material.metallic, 0.0f);
  EXPECT_EQ(material.dielectric_f0, 0.0f) << "mirrors nothing";
  EXPECT_EQ(material.emissive, glm::vec3(0)) << "what else the file says is for programs that know no unlit";
}

TEST_F(GltfFile, UnknownRequiredExtensionIsNamed) {
  Gltf gltf = triangle();
  gltf.extra = R"("extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"],)";
  EXPECT_NE(load_error(gltf).find("KHR_draco_mesh_compression"), std::string::npos);
}

TEST_F(GltfFile, BaseColourTextureEndsUpInTheVertices) {
  // Two texels side by side, red and mid-grey, sampled in their middles; moved by KHR_texture_transform for the second load.
  cv::Mat picture(1, 2, CV_8UC3);
  picture.at<cv::Vec3b>(0, 0) = {0, 0, 255};
  picture.at<cv::Vec3b>(0, 1) = {188, 188, 188};
  cv::imwrite(folder_ / "texture.png", picture);
  const auto textured = [](const std::string& info) {
    Gltf gltf = triangle();
    const int uv = gltf.vectors({0.25f, 0.5f, 0.75f, 0.5f, 1.25f, 0.5f}, "VEC2", 2);
    gltf.primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(uv) + R"(},"material":0)";
    gltf.materials = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0)" + info + "}}}";
    gltf.extra = R"("textures":[{"source":0}],"images":[{"uri":"texture.png"}],)";
    return gltf;
  };
  Mesh mesh = load(textured(""));
  fold_base_color_textures(mesh);
  const float grey = static_cast<float>(linear_from_srgb(188 / 255.0));
  EXPECT_LT(glm::distance(mesh.vertices[0].color, glm::vec3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(mesh.vertices[1].color, glm::vec3(grey)), 1e-6f);
  EXPECT_LT(glm::distance(mesh.vertices[2].color, glm::vec3(1, 0, 0)), 1e-6f) << "repeats";
  Mesh moved = load(textured(R"(,"extensions":{"KHR_texture_transform":{"offset":[0.5,0]}})"));
  fold_base_color_textures(moved);
  EXPECT_LT(glm::distance(moved.vertices[0].color, glm::vec3(grey)), 1e-6f);
  write_text(folder_ / "texture.png", "no picture");
  EXPECT_NE(load_error(textured("")).find("texture.png"), std::string::npos);
}

TEST_F(GltfFile, NamesTheFilesThatItIsReadFrom) {
  write_text(folder_ / "a.gltf", R"({"buffers":[{"uri":"a.bin"},{"uri":"data:x,y"},{}],"images":[{"uri":"textures/b.png"}]})");
  EXPECT_THAT(files_of_mesh(folder_ / "a.gltf"),
              testing::ElementsAre(folder_ / "a.gltf", folder_ / "a.bin", folder_ / "textures/b.png"));
  write_text(folder_ / "broken.gltf", R"({"buffers":[{"uri)");
  EXPECT_THAT(files_of_mesh(folder_ / "broken.gltf"), testing::ElementsAre(folder_ / "broken.gltf"));
  EXPECT_THAT(files_of_mesh(folder_ / "missing.obj"), testing::ElementsAre(folder_ / "missing.obj"));
}

TEST_F(GltfFile, NonFinitePositionsAreRefused) {
  Gltf gltf;
  gltf.primitive = R"("attributes":{"POSITION":)" + std::to_string(gltf.vectors({0, 0, 0, NAN, 0, 0, 0, 1, 0}, "VEC3", 3)) + "}";
  EXPECT_NE(load_error(gltf).find("vertex 1"), std::string::npos);
}

TEST_F(GltfFile, TrianglesWithoutAreaAreDroppedWithAWarning) {
  Gltf gltf;
  gltf.primitive = R"("attributes":{"POSITION":)" +
                   std::to_string(gltf.vectors({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3", 3)) + "}";
  EXPECT_EQ(load(gltf).indices.size(), 3u);
  ASSERT_EQ(warnings_.all.size(), 1u);
  EXPECT_NE(warnings_.all[0].find("1 triangle without area"), std::string::npos);
}

TEST_F(GltfFile, DamagedGltfIsNamed) {
  const std::string text = triangle().text();
  for (const std::string& bad : {std::string(), std::string("{"), text.substr(0, text.size() / 2), std::string("glTF") + text,
                                 std::string(R"({"asset":{"version":"2.0"}})")}) {
    write_text(folder_ / "bad.glb", bad);
    EXPECT_NE(error_of([&] { load("bad.glb"); }).find("bad.glb"), std::string::npos);
  }
}

}  // namespace
}  // namespace catchlight::render
