// What is said of glTF files that hold more than is drawn, or less than they claim.
#include "tests/render/mesh_file/gltf_text.hpp"

#include <gmock/gmock.h>

namespace catchlight::render {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Gltf with_materials(const std::string& materials) {
  Gltf gltf = textured_triangle();
  gltf.materials = materials;
  return gltf;
}

TEST_F(GltfFile, AlphaModesAreNamedWhereTheyMatter) {
  load(with_materials(R"({"name":"leaf","alphaMode":"MASK","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.2]}},
                         {"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.2]}},
                         {"name":"closed","alphaMode":"BLEND"})"));
  EXPECT_THAT(warnings_.all, ElementsAre(AllOf(HasSubstr("a.gltf: alphaMode MASK is not used"), HasSubstr("(material \"leaf\")")),
                                         AllOf(HasSubstr("alphaMode BLEND is not used"), HasSubstr("(material \"1\")"))));
}

TEST_F(GltfFile, TheOpacityOfVerticesIsNamed) {
  Gltf gltf = triangle();
  const int colors = gltf.vectors({1, 0, 0, 1, 1, 0, 0, 0.5f, 1, 0, 0, 1}, "VEC4", 4);
  gltf.primitive = R"("attributes":{"POSITION":0,"COLOR_0":)" + std::to_string(colors) + R"(},"material":0)";
  gltf.materials = R"({"name":"veil","alphaMode":"BLEND"})";
  EXPECT_EQ(load(gltf).vertices[1].color, glm::vec3(1, 0, 0));
  EXPECT_THAT(warnings_.all, ElementsAre(AllOf(HasSubstr("opacity of vertices"), HasSubstr("\"veil\""))));
}

TEST_F(GltfFile, AFeatureIsNamedOnceForAllItsMaterials) {
  std::string materials;
  for (const char* name : {"a", "b", "c", "d", "e"})
    materials += std::string(materials.empty() ? "" : ",") + R"({"name":")" + name +
                 R"(","normalTexture":{"index":0},"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}})";
  Gltf gltf = with_materials(materials);
  gltf.extra = R"("extensionsUsed":["KHR_materials_transmission"],"textures":[{"source":0}],"images":[{"uri":"grey.png"}],)";
  write_picture("grey.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(128)));
  load(gltf);
  EXPECT_THAT(warnings_.all, ElementsAre(AllOf(HasSubstr("glass is opaque (KHR_materials_transmission"),
                                               HasSubstr("material \"a\", \"b\", \"c\" and 2 more"))));
}

TEST_F(GltfFile, OnlyMapsThatAreNotDrawnAreNamed) {
  Gltf gltf = with_materials(R"({"name":"m","pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}},
      "occlusionTexture":{"index":0},"emissiveTexture":{"index":0},
      "extensions":{"KHR_materials_specular":{"specularTexture":{"index":0}}}})");
  gltf.extra = R"("extensionsUsed":["KHR_materials_specular"],"textures":[{"source":0}],"images":[{"uri":"grey.png"}],)";
  write_picture("grey.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(128)));
  load(gltf);
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("specular maps")));
}

TEST_F(GltfFile, OtherScenesAreNamed) {
  std::string text = triangle().text();
  text.replace(text.find(R"({"nodes":[0]})"), 13, R"({"nodes":[0]},{"nodes":[]})");
  write_text(folder_ / "two.gltf", text);
  load("two.gltf");
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("of its 2 scenes")));
}

TEST_F(GltfFile, WhatMovesTheObjectIsNamed) {
  Gltf gltf = triangle();
  gltf.nodes = R"({"mesh":0,"weights":[0,0.5]})";
  gltf.extra = R"("animations":[{"channels":[],"samplers":[]}],"skins":[{"joints":[0]}],)"
               R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],)";
  load(gltf);
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("animation"), HasSubstr("cameras")));
}

TEST_F(GltfFile, ExtensionsAreNamedAndLightsAreNoReasonToRefuse) {
  Gltf gltf = triangle();
  gltf.extra = R"("extensionsUsed":["KHR_lights_punctual","ACME_smell","KHR_texture_transform"],)"
               R"("extensionsRequired":["KHR_lights_punctual"],)";
  EXPECT_EQ(load(gltf).indices.size(), 3u);
  EXPECT_THAT(warnings_.all, ElementsAre(AllOf(HasSubstr("lights are not used"), HasSubstr("KHR_lights_punctual")),
                                         HasSubstr("the glTF extension ACME_smell is not used")));
}

TEST_F(GltfFile, WhatIsDrawnIsNotNamed) {
  Gltf gltf = with_materials(R"({"doubleSided":true,"extensions":{"KHR_materials_ior":{"ior":1.4},"KHR_materials_unlit":{}}})");
  gltf.extra = R"("extensionsUsed":["KHR_materials_ior","KHR_materials_unlit"],)";
  load(gltf);
  EXPECT_THAT(warnings_.all, IsEmpty());
}

TEST_F(GltfFile, TexturesThatCannotBeReadSayWhy) {
  const auto textured = [](const std::string& texture, const std::string& image) {
    Gltf gltf = with_materials(R"({"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
    gltf.extra = "\"textures\":[" + texture + R"(],"images":[{"uri":")" + image + "\"}],";
    return gltf;
  };
  EXPECT_THAT(load_error(textured(R"({"source":0})", "missing.png")), HasSubstr("texture \"missing.png\" is not there"));
  EXPECT_THAT(load_error(textured(R"({"extensions":{"KHR_texture_basisu":{"source":0}}})", "t.ktx2")),
              AllOf(HasSubstr("KHR_texture_basisu"), HasSubstr("PNG")));
}

TEST_F(GltfFile, AccessorsWithoutDataAreZeros) {
  Gltf gltf = triangle();
  const int normals = gltf.accessor(R"("componentType":5126,"type":"VEC3","count":3)");
  gltf.primitive = R"("attributes":{"POSITION":0,"NORMAL":)" + std::to_string(normals) + "}";
  EXPECT_EQ(load(gltf).vertices[0].normal, glm::vec3(0, 0, 1)) << "a normal of zero is none";
}

TEST_F(GltfFile, OtherFilesAreToldInOurWords) {
  write_text(folder_ / "probe.glb", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\nabcd");
  EXPECT_THAT(error_of([&] { load("probe.glb"); }), AllOf(HasSubstr("probe.glb: is no glTF"), Not(HasSubstr("json"))));
  write_text(folder_ / "cut.gltf", R"({"asset":{"version":)");
  EXPECT_THAT(error_of([&] { load("cut.gltf"); }), AllOf(HasSubstr("its JSON is damaged"), Not(HasSubstr("exception"))));
  std::string text = triangle().text();
  text.replace(text.find("2.0"), 3, "1.0");
  write_text(folder_ / "old.gltf", text);
  EXPECT_THAT(error_of([&] { load("old.gltf"); }), AllOf(HasSubstr("glTF 1.0"), HasSubstr("expected glTF 2.0")));
}

}  // namespace
}  // namespace catchlight::render
