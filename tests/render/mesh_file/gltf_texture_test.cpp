// Textures of glTF files, and what is wrong with them.
#include "tests/render/mesh_file/gltf_text.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

namespace catchlight::render {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kPainted = R"({"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";

Gltf textured(const std::string& material, const std::string& image = R"({"uri":"a.png"})") {
  Gltf gltf = textured_triangle();
  gltf.materials = material;
  gltf.extra = R"("textures":[{"source":0}],"images":[)" + image + "],";
  return gltf;
}

class GltfTexture : public GltfFile {
 protected:
  GltfTexture() { write_picture("a.png", cv::Mat(2, 4, CV_8UC3, cv::Scalar(10, 100, 200))); }
};

TEST_F(GltfTexture, EveryMapGoesIntoItsMaterial) {
  Gltf gltf = textured(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}},
      "normalTexture":{"index":0,"scale":0.5},"occlusionTexture":{"index":0,"strength":0.25},"emissiveTexture":{"index":1}})");
  gltf.extra = R"("textures":[{"source":0},{"source":0,"sampler":0}],"images":[{"uri":"a.png"}],
      "samplers":[{"wrapS":33071,"wrapT":33648}],)";
  const Mesh mesh = load(gltf);
  const Material& material = mesh.materials.at(0);
  ASSERT_EQ(mesh.textures.size(), 3u) << "as colour, as data, and as colour with other wraps";
  EXPECT_EQ(material.normal_texture.strength, 0.5f);
  EXPECT_EQ(material.occlusion_texture.strength, 0.25f);
  EXPECT_EQ(material.metallic_roughness_texture.texture, material.normal_texture.texture);
  EXPECT_TRUE(mesh.textures[static_cast<std::size_t>(material.base_color_texture.texture)]->is_srgb);
  EXPECT_FALSE(mesh.textures[static_cast<std::size_t>(material.occlusion_texture.texture)]->is_srgb);
  const Texture& emissive = *mesh.textures[static_cast<std::size_t>(material.emissive_texture.texture)];
  EXPECT_TRUE(emissive.is_srgb);
  EXPECT_THAT(emissive.wrap, ElementsAre(TextureWrap::clamp, TextureWrap::mirror));
  EXPECT_EQ(emissive.levels[0].width, 4);
  EXPECT_THAT(std::vector<int>(emissive.levels[0].rgba.begin(), emissive.levels[0].rgba.begin() + 4),
              ElementsAre(200, 100, 10, 255));
  EXPECT_LT(glm::distance(mesh.texture_coordinates[1].uv[0], glm::vec2(1, 0)), 1e-6f);
  EXPECT_LT(glm::distance(mesh.texture_coordinates[0].tangent, glm::vec4(1, 0, 0, -1)), 1e-6f) << "v runs up here: mirrored";
}

TEST_F(GltfTexture, SetsAndTransformsAreThoseOfEachTexture) {
  Gltf gltf = textured(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":3}},"emissiveTexture":{"index":0,
      "extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"rotation":1.5707963,"scale":[2,3],"texCoord":0}}}})");
  const int other = gltf.vectors({9, 0, 9, 1, 9, 2}, "VEC2", 2);
  gltf.primitive.replace(gltf.primitive.find("TEXCOORD_0"), 10, R"(TEXCOORD_3":)" + std::to_string(other) + R"(,"TEXCOORD_0)");
  const Mesh mesh = load(gltf);
  const Material& material = mesh.materials.at(0);
  const TextureCoordinates& vertex = mesh.texture_coordinates.at(1);
  EXPECT_EQ(vertex.uv[static_cast<std::size_t>(material.base_color_texture.set)], glm::vec2(9, 1));
  EXPECT_EQ(vertex.uv[static_cast<std::size_t>(material.emissive_texture.set)], glm::vec2(1, 0));
  const glm::vec3 moved = material.emissive_texture.uv_transform * glm::vec3(1, 1, 1);
  EXPECT_LT(glm::distance(moved, glm::vec3(0.5f + 3, 0.25f - 2, 1)), 1e-5f) << "the extension's own example of a matrix";
}

TEST_F(GltfTexture, TangentsOfTheFileAreUsedAndBadOnesMadeAnew) {
  Gltf gltf = textured(R"({"normalTexture":{"index":0}})");
  const int tangents = gltf.vectors({0, 1, 0, 1, NAN, 0, 0, 1, 0, 0, 0, 1}, "VEC4", 4);
  gltf.primitive.replace(gltf.primitive.find("TEXCOORD_0"), 10, R"(TANGENT":)" + std::to_string(tangents) + R"(,"TEXCOORD_0)");
  const Mesh mesh = load(gltf);
  EXPECT_THAT(warnings_.all, testing::Contains(HasSubstr("a.gltf: 2 tangents are not of length 1")));
  EXPECT_EQ(mesh.texture_coordinates[0].tangent, glm::vec4(0, 1, 0, 1));
  for (const std::size_t v : {1, 2}) EXPECT_LT(glm::distance(mesh.texture_coordinates[v].tangent, glm::vec4(1, 0, 0, -1)), 1e-6f);
}

TEST_F(GltfTexture, MissingCoordinatesLeaveTheTextureOut) {
  Gltf gltf = textured(R"({"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}})");
  const Mesh mesh = load(gltf);
  EXPECT_FALSE(mesh.materials.at(0).has_textures());
  EXPECT_THAT(warnings_.all,
              testing::Contains(AllOf(HasSubstr("no texture coordinates TEXCOORD_1"), HasSubstr("(material \"m\")"))));
}

TEST_F(GltfTexture, CoordinatesThatAreNotFiniteCountAsZero) {
  Gltf gltf = textured(kPainted);
  const int uv = gltf.vectors({0, 0, NAN, 0, 0, INFINITY}, "VEC2", 2);
  gltf.primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(uv) + R"(},"material":0)";
  EXPECT_EQ(load(gltf).texture_coordinates[1].uv[0], glm::vec2(0));
  EXPECT_THAT(warnings_.all, testing::Contains(HasSubstr("2 texture coordinates are not finite")));
}

TEST_F(GltfTexture, PicturesOfEveryKind) {
  const auto first_texel = [&] {
    const Mesh mesh = load(textured(kPainted));
    const std::vector<std::uint8_t>& rgba = mesh.textures.at(0)->levels[0].rgba;
    return std::vector<int>(rgba.begin(), rgba.begin() + 4);
  };
  write_picture("a.png", cv::Mat(1, 1, CV_8UC1, cv::Scalar(77)));
  EXPECT_THAT(first_texel(), ElementsAre(77, 77, 77, 255)) << "grey";
  write_picture("a.png", cv::Mat(1, 1, CV_16UC3, cv::Scalar(0x1234, 0x5678, 0x9abc)));
  EXPECT_THAT(first_texel(), ElementsAre(0x9a, 0x56, 0x12, 255)) << "16 bits";
  write_picture("a.png", cv::Mat(1, 1, CV_8UC4, cv::Scalar(1, 2, 3, 4)));
  EXPECT_THAT(first_texel(), ElementsAre(3, 2, 1, 4)) << "with opacity";
}

/// One pixel of magenta and yellow ink, as Adobe's programs write CMYK: inverted.
TEST_F(GltfTexture, JpegsOfInksAreRead) {
  const std::string jpeg =
      "/9j/7gAOQWRvYmUAZAAAAAAA/9sAQwABAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEB"
      "AQEBAQEBAQEBAQEB/8AAFAgAAQABBEMRAE0RAFkRAEsRAP/EABUAAQEAAAAAAAAAAAAAAAAAAAoL/8QAFBABAAAAAAAAAAAAAAAA"
      "AAAAAP/aAA4EQwBNAFkASwAAPwB/Cf8Ap/5/D//Z";
  const Mesh mesh = load(textured(kPainted, R"({"uri":"data:image/jpeg;base64,)" + jpeg + "\"}"));
  const std::vector<std::uint8_t>& rgba = mesh.textures.at(0)->levels[0].rgba;
  EXPECT_NEAR(rgba[0], 255, 2);
  EXPECT_NEAR(rgba[1], 0, 2);
  EXPECT_NEAR(rgba[2], 0, 2);
  EXPECT_EQ(rgba[3], 255);
}

TEST_F(GltfTexture, PicturesThatAreTooLargeAreScaledDown) {
  cv::Mat wide(2, 16384, CV_8UC3, cv::Scalar(0, 0, 0));
  wide.colRange(0, 4).setTo(cv::Scalar(0, 0, 255));
  write_picture("a.png", wide);
  const TextureLevel level = load(textured(kPainted)).textures.at(0)->levels[0];
  EXPECT_EQ(level.width, 8192);
  EXPECT_EQ(level.rgba[4], 255) << "the second texel is the third and fourth pixel's";
  EXPECT_EQ(level.rgba[8], 0);
  EXPECT_THAT(warnings_.all, testing::Contains(AllOf(HasSubstr("\"a.png\""), HasSubstr("16384 x 2"), HasSubstr("8192 x 1"))));
}

TEST_F(GltfTexture, JpegsThatAreTooLargeAreScaledDown) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", cv::Mat(16, 16384, CV_8UC3, cv::Scalar::all(128)), jpeg);
  write_text(folder_ / "a.jpg", std::string(jpeg.begin(), jpeg.end()));
  const TextureLevel level = load(textured(kPainted, R"({"uri":"a.jpg"})")).textures.at(0)->levels[0];
  EXPECT_EQ(level.width, 8192);
  EXPECT_EQ(level.height, 8);
  EXPECT_NEAR(level.rgba[0], 128, 1);
  EXPECT_THAT(warnings_.all, testing::Contains(HasSubstr("16384 x 16")));
}

TEST_F(GltfTexture, DataThatIsBrokenIsNamed) {
  for (const char* uri : {"data:image/png;base64,@@@@", "data:image/png;base64,", "data:image/png;base64,AAAA"}) {
    const std::string error = load_error(textured(kPainted, std::string(R"({"uri":")") + uri + "\"}"));
    EXPECT_THAT(error, AllOf(HasSubstr("a.gltf"), HasSubstr("image"))) << uri;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST_F(GltfTexture, OpacityIsRead) {
  const Material leaf = load(textured(R"({"alphaMode":"MASK","alphaCutoff":0.3,"doubleSided":true,
      "pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}})"))
                            .materials.at(0);
  EXPECT_EQ(leaf.alpha_mode, AlphaMode::mask);
  EXPECT_FLOAT_EQ(leaf.alpha_cutoff, 0.3f);
  EXPECT_FLOAT_EQ(leaf.opacity, 0.5f);
  EXPECT_TRUE(leaf.is_double_sided);
  const Material solid = load(textured(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}})")).materials.at(0);
  EXPECT_EQ(solid.alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(solid.opacity, 1) << "alpha counts only where the mode says so";
}

}  // namespace
}  // namespace catchlight::render
