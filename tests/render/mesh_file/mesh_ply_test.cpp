// What is read of PLY files, and what is refused.
#include "render/image/picture_file.hpp"
#include "render/mesh_file/mesh_file.hpp"
#include "tests/support/test_files.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

namespace catchlight::render {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kPlace = "property float x\nproperty float y\nproperty float z\n";
const std::string kFace = "property list uchar int vertex_indices\n";
const std::string kTriangle = "ply\nformat ascii 1.0\nelement vertex 3\n" + kPlace + "element face 1\n" + kFace +
                              "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

template <typename T>
std::string bytes(T value, bool big_endian) {
  std::string text(reinterpret_cast<const char*>(&value), sizeof value);
  if (big_endian) std::reverse(text.begin(), text.end());
  return text;
}

// The triangle in binary.
std::string binary_triangle(bool big_endian) {
  std::string ply = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") + "_endian 1.0\nelement vertex 3\n" +
                    kPlace + "element face 1\n" + kFace + "end_header\n";
  for (const float value : {0, 0, 0, 1, 0, 0, 0, 1, 0}) ply += bytes(value, big_endian);
  ply += '\3';
  for (const std::int32_t value : {0, 1, 2}) ply += bytes(value, big_endian);
  return ply;
}

class PlyFile : public testing::Test {
 protected:
  Mesh load(const std::string& text) {
    write_text(folder_ / "a.ply", text);
    return load_mesh(folder_ / "a.ply", warnings_.handler());
  }
  std::string load_error(const std::string& text) {
    return error_of([&] { load(text); });
  }

  TempFolder folder_;
  Warnings warnings_;
};

void expect_triangle(const Mesh& mesh) {
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[1].position_m, glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.vertices[2].position_m, glm::vec3(0, 1, 0));
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  for (const Vertex& vertex : mesh.vertices) EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
}

TEST_F(PlyFile, TextAndBinaryOfBothOrders) {
  for (const std::string& text : {kTriangle, binary_triangle(false), binary_triangle(true)}) expect_triangle(load(text));
  EXPECT_TRUE(warnings_.all.empty());
}

TEST_F(PlyFile, WhatElseStandsInItIsReadOver) {
  expect_triangle(
      load("ply\r\nformat ascii 1.0\r\ncomment by a scanner\r\nobj_info num_cols 512\r\nelement camera 1\r\n"
           "property list uchar float view\r\nelement vertex 3\r\ncomment corner points\r\nproperty uchar flags\r\n" +
           kPlace + "property list uint8 double weights\r\nelement face 1\r\nproperty int32 id\r\n" + kFace +
           "property list uchar float texcoord\r\nend_header\r\n2 7 8\r\n1 0 0 0 0\r\n1 1 0 0 1 5\r\n1 +0 1 0 2 5 6\r\n"
           "7 3 0 1 2 6 0 0 1 0 0 1"));
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("\"camera\" is not used")));
}

TEST_F(PlyFile, FacesMayStandBeforeTheVertices) {
  expect_triangle(load("ply\nformat ascii 1.0\nelement face 1\n" + kFace + "element vertex 3\n" + kPlace +
                       "end_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n"));
}

TEST_F(PlyFile, NormalsAreTheFilesOwn) {
  const std::string normal = "property float nx\nproperty float ny\nproperty float nz\n";
  const Mesh mesh = load("ply\nformat ascii 1.0\nelement vertex 3\n" + kPlace + normal + "element face 1\n" + kFace +
                         "end_header\n0 0 0 0 0.6 0.8\n1 0 0 0 0.6 0.8\n0 1 0 0 0.6 0.8\n3 0 1 2\n");
  EXPECT_LT(glm::distance(mesh.vertices[2].normal, glm::vec3(0, 0.6f, 0.8f)), 1e-6f);
}

TEST_F(PlyFile, StripsKeepTheirWinding) {
  const Mesh mesh = load("ply\nformat ascii 1.0\nelement vertex 4\n" + kPlace +
                         "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                         "0 0 0\n1 0 0\n0 1 0\n1 1 0\n9 0 1 2 3 -1 2 1 3 -1\n");
  ASSERT_EQ(mesh.indices.size(), 9u);
  for (const Vertex& vertex : mesh.vertices) EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
}

TEST_F(PlyFile, FilesThatAreCutAnywhereAreRefused) {
  for (const std::string& whole : {kTriangle, binary_triangle(false)}) {
    for (std::size_t size = 0; size + 2 < whole.size(); ++size)
      EXPECT_THAT(load_error(whole.substr(0, size)), HasSubstr("a.ply: ")) << size << " bytes";
  }
}

TEST_F(PlyFile, WhatIsWrongIsNamed) {
  const auto replaced = [](std::string text, const std::string& what, const std::string& with) {
    return text.replace(text.find(what), what.size(), with);
  };
  EXPECT_THAT(load_error(replaced(kTriangle, "3 0 1 2", "3 0 1 7")), HasSubstr("face 0 names vertex 7 of 3"));
  EXPECT_THAT(load_error(replaced(kTriangle, "3 0 1 2", "3 0 1 -1")), HasSubstr("vertex -1 of 3"));
  EXPECT_THAT(load_error(replaced(kTriangle, "3 0 1 2", "3 0 1 nan")), HasSubstr("vertex nan of 3"));
  EXPECT_THAT(load_error(replaced(kTriangle, "3 0 1 2", "300 0 1 2")), HasSubstr("300 values"));
  EXPECT_THAT(load_error(replaced(kTriangle, "3 0 1 2", "-3 0 1 2")), HasSubstr("-3 values"));
  EXPECT_THAT(load_error(replaced(kTriangle, "1 0 0", "1 x 0")), HasSubstr("\"x\""));
  EXPECT_THAT(load_error(replaced(kTriangle, "vertex 3", "vertex 4000000000")), HasSubstr("promises 4000000000"));
  EXPECT_THAT(load_error(replaced(kTriangle, "vertex 3", "vertex -3")), HasSubstr("element NAME COUNT"));
  EXPECT_THAT(load_error(replaced(kTriangle, "float x", "half x")), HasSubstr("\"half\""));
  EXPECT_THAT(load_error(replaced(kTriangle, "float x", "float a")), HasSubstr("x, y and z"));
  EXPECT_THAT(load_error(replaced(kTriangle, "ascii", "utf8")), HasSubstr("\"utf8\""));
  EXPECT_THAT(load_error(replaced(kTriangle, "0 1 0", "0 inf 0")), HasSubstr("vertex 2 has no finite position"));
  EXPECT_THAT(load_error("#?RADIANCE\n"), HasSubstr("expected a PLY file"));
}

TEST_F(PlyFile, PointsWithoutFacesAreCounted) {
  EXPECT_THAT(load_error("ply\nformat ascii 1.0\nelement vertex 2\n" + kPlace + "end_header\n0 0 0\n1 0 0\n"),
              AllOf(HasSubstr("no faces"), HasSubstr("2 points")));
}

std::string unfolded(const std::string& u, const std::string& v) {
  return "ply\nformat ascii 1.0\ncomment TextureFile scan.png\nelement vertex 3\n" + kPlace + "property float " + u +
         "\nproperty float " + v + "\nelement face 1\n" + kFace + "end_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
}

TEST_F(PlyFile, TexturesOfVerticesAreReadAndVRunsDown) {
  write_png(folder_ / "scan.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar(10, 100, 200)));
  for (const auto& [u, v] : {std::pair("texture_u", "texture_v"), std::pair("s", "t"), std::pair("u", "v")}) {
    const Mesh mesh = load(unfolded(u, v));
    ASSERT_EQ(mesh.textures.size(), 1u) << u;
    EXPECT_TRUE(mesh.textures[0]->is_srgb);
    EXPECT_EQ(mesh.textures[0]->levels[0].rgba[0], 200);
    EXPECT_EQ(mesh.materials[0].base_color_texture.texture, 0);
    EXPECT_EQ(mesh.materials[0].base_color, glm::vec3(1));
    EXPECT_EQ(mesh.texture_coordinates[0].uv[0], glm::vec2(0, 1));
    EXPECT_EQ(mesh.texture_coordinates[2].uv[0], glm::vec2(0, 0));
  }
  EXPECT_THAT(files_of_mesh(folder_ / "a.ply"), ElementsAre(folder_ / "a.ply", folder_ / "scan.png"));
}

TEST_F(PlyFile, ATextureThatIsNotThereIsLeftOut) {
  const Mesh mesh = load(unfolded("s", "t"));
  EXPECT_FALSE(mesh.has_textures());
  EXPECT_THAT(warnings_.all, ElementsAre(AllOf(HasSubstr("a.ply"), HasSubstr("scan.png"), HasSubstr("is not there"))));
}

TEST_F(PlyFile, WhatIsNotUsedIsSaidOnce) {
  std::string text = kTriangle;
  text.replace(text.find("element vertex"), 0, "comment TextureFile scan.png\n");
  text.replace(text.find("end_header"), 0, "property uchar red\n");
  text.insert(text.size() - 1, " 255");
  expect_triangle(load(text));
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("colours of faces"), HasSubstr("TextureFile scan.png")));
}

}  // namespace
}  // namespace catchlight::render
