// What is read of Wavefront's OBJ, and what is refused.
#include "catchlight/color.hpp"
#include "render/image/picture_file.hpp"
#include "render/mesh_file/mesh_file.hpp"
#include "render/mesh_file/mesh_import.hpp"
#include "tests/support/test_files.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

namespace catchlight::render {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class ObjFile : public testing::Test {
 protected:
  Mesh load(const std::string& text) {
    write_text(folder_ / "a.obj", text);
    return load_mesh(folder_ / "a.obj", warnings_.handler());
  }
  std::string load_error(const std::string& text) {
    return error_of([&] { load(text); });
  }

  TempFolder folder_;
  Warnings warnings_;
};

double area_of(const Mesh& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](int k) { return glm::dvec3(mesh.vertices[mesh.indices[i + k]].position_m); };
    area += glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z / 2;
  }
  return area;
}

TEST_F(ObjFile, CornersOfEveryKind) {
  const std::string attributes = kSquare + "vt 0 0\nvn 0 0 1\n";
  for (const char* face : {"f 1 2 3 4", "f 1/1 2/1 3/1 4/1", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/1/1 3/1/1 4/1/1",
                           "f -4 -3 -2 -1", "\tf  1\t2  3 4 \r", "f 1 2 \\\n3 4", "f 1 2 3 4 # a square"}) {
    const Mesh mesh = load(attributes + face + "\n");
    EXPECT_NEAR(area_of(mesh), 1, 1e-9) << face;
    EXPECT_EQ(mesh.vertices.size(), 4u) << face;
  }
  EXPECT_TRUE(warnings_.all.empty());
}

TEST_F(ObjFile, ConcavePolygonsAreNotFilledAcrossTheirNotch) {
  // An arrow head: from its first corner a fan would leave it.
  EXPECT_NEAR(area_of(load("v 0 0 0\nv 2 -1 0\nv 1 0 0\nv 2 1 0\nf 2 3 4 1\n")), 1, 1e-9);
  // A comb of five teeth.
  std::string comb, face = "f";
  const double notch[] = {1, 0.1};
  comb = "v 0 0 0\nv 10 0 0\n";
  for (int i = 0; i <= 10; ++i) comb += "v " + std::to_string(10 - i) + " " + std::to_string(notch[i % 2]) + " 0\n";
  for (int i = 1; i <= 13; ++i) face += " " + std::to_string(i);
  const Mesh mesh = load(comb + face + "\n");
  EXPECT_NEAR(area_of(mesh), 5.5, 1e-6);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](int k) { return mesh.vertices[mesh.indices[i + k]].position_m; };
    EXPECT_GT(glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z, 0);
  }
}

TEST_F(ObjFile, PolygonsThatCrossThemselvesStillEnd) {
  EXPECT_EQ(load("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1.1 0\nf 1 2 3 4\n").indices.size() % 3, 0u);
  std::string zigzag, face = "f";
  for (int i = 1; i <= 3000; ++i) {
    zigzag += "v " + std::to_string(i) + " " + std::to_string(i % 2) + " 0\n";
    face += " " + std::to_string(i);
  }
  EXPECT_FALSE(load(zigzag + face + "\n").indices.empty());
}

TEST_F(ObjFile, ColoursOfVerticesAreDecoded) {
  const Mesh mesh = load("v 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\nv 0 1 0 1 0.5 0\nf 1 2 3\n");
  EXPECT_NEAR(mesh.vertices[0].color.y, linear_from_srgb(0.5), 1e-6);
  EXPECT_EQ(load("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").vertices[0].color, glm::vec3(1)) << "the fourth is a weight";
}

TEST_F(ObjFile, BlendersRoughnessAndMetalnessGoBeforeTheExponent) {
  write_text(folder_ / "a.mtl", "newmtl steel\nPr 0.3\nPm 1\nNs 10\n");
  const Material material = load("mtllib a.mtl\nusemtl steel\n" + kSquare + "f 1 2 3\n").materials.at(0);
  EXPECT_FLOAT_EQ(material.roughness, 0.3f);
  EXPECT_FLOAT_EQ(material.metallic, 1.0f);
}

TEST_F(ObjFile, FilesWithoutFacesSayWhatTheyHold) {
  EXPECT_THAT(load_error(kSquare), AllOf(HasSubstr("a.obj"), HasSubstr("no faces, only 4 points")));
  EXPECT_THAT(load_error("#?RADIANCE\n"), HasSubstr("expected Wavefront OBJ"));
  EXPECT_THAT(load_error(""), HasSubstr("no faces"));
}

TEST_F(ObjFile, WhatIsWrongIsNamedByItsLine) {
  EXPECT_THAT(load_error(kSquare + "f 1 2 99\n"), AllOf(HasSubstr("a.obj:5:"), HasSubstr("vertex 99 of 4")));
  EXPECT_THAT(load_error(kSquare + "f 1 2 -5\n"), HasSubstr("vertex -5 of 4"));
  EXPECT_THAT(load_error(kSquare + "f 0 1 2\n"), HasSubstr("vertex 0 of 4"));
  EXPECT_THAT(load_error(kSquare + "f 1//1 2//1 3//1\n"), HasSubstr("normal 1 of 0"));
  EXPECT_THAT(load_error("v 0 0 0\nv 1 \\\n0 x\n"), AllOf(HasSubstr("a.obj:2:"), HasSubstr("\"x\" is not a finite number")));
  EXPECT_THAT(load_error("v 0 0\n"), HasSubstr("too few numbers"));
  EXPECT_THAT(load_error("v 0 0 nan\n"), HasSubstr("nan"));
  write_text(folder_ / "a.mtl", "newmtl x\nKd red\n");
  EXPECT_THAT(load_error("mtllib a.mtl\n"), AllOf(HasSubstr("a.mtl:2:"), HasSubstr("red")));
}

TEST_F(ObjFile, AMissingLibraryIsSaid) {
  load("mtllib materials of it.mtl\nusemtl x\n" + kSquare + "f 1 2 3\n");
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("\"materials of it.mtl\" is not there")));
}

TEST_F(ObjFile, WhatIsNotUsedIsSaidOnce) {
  write_text(folder_ / "a.mtl",
             "newmtl a\nd 0.2\nmap_Kd -s 2 2 2 a.png\nPc 0.5\nnewmtl b\nd 0.5\nTr 0\nPc 0\nnewmtl c\nd 1\nmap_Kd b.png\nbump "
             "c.png\ndisp c.png\n");
  for (const char* name : {"a.png", "b.png"}) write_png(folder_ / name, cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(9)));
  write_png(folder_ / "c.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar(255, 128, 128)));
  load("mtllib a.mtl\n" + kSquare + "vt 0 0\nl 1 2\nl 2 3\np 1\nf 1 2\nusemtl a\nf 1/1 2/1 3/1\n");
  EXPECT_THAT(warnings_.all, ElementsAre(AllOf(HasSubstr("a.obj: transparency (d)"), HasSubstr("(material \"a\", \"b\")")),
                                         HasSubstr("clear coat"), AllOf(HasSubstr("maps (disp)"), HasSubstr("\"c\"")),
                                         HasSubstr("points and lines are left out"), HasSubstr("fewer than three corners")));
}

class TexturedObj : public ObjFile {
 protected:
  /// A square with the library's material "m"; the whole picture lies on it upright.
  Mesh load_square(const std::string& library, const std::string& face = "f 1/1 2/2 3/3 4/4\n") {
    write_text(folder_ / "a.mtl", "newmtl m\n" + library);
    return load("mtllib a.mtl\n" + kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\n" + face);
  }
  void write_picture(const std::string& name, const cv::Scalar& bgr) { write_png(folder_ / name, cv::Mat(2, 2, CV_8UC3, bgr)); }
  static const Texture& texture(const Mesh& mesh, const MaterialTexture& use) {
    return *mesh.textures.at(static_cast<std::size_t>(use.texture));
  }
};

TEST_F(TexturedObj, MapsGoIntoTheMaterialAndVRunsDown) {
  write_picture("wood.png", cv::Scalar(10, 100, 200));
  const Mesh mesh = load_square("Kd 0 0 0\nmap_Kd -clamp on wood.png\nmap_Ke wood.png\n");
  const Material& material = mesh.materials.at(0);
  EXPECT_EQ(material.base_color, glm::vec3(1)) << "black times a map would hide it";
  EXPECT_EQ(material.emissive, glm::vec3(1));
  EXPECT_TRUE(texture(mesh, material.base_color_texture).is_srgb);
  EXPECT_EQ(texture(mesh, material.base_color_texture).wrap[0], TextureWrap::clamp);
  EXPECT_EQ(texture(mesh, material.emissive_texture).wrap[0], TextureWrap::repeat);
  EXPECT_EQ(texture(mesh, material.base_color_texture).levels[0].rgba[0], 200);
  ASSERT_EQ(mesh.texture_coordinates.size(), 4u);
  EXPECT_EQ(mesh.texture_coordinates[0].uv[0], glm::vec2(0, 1));
  EXPECT_EQ(mesh.texture_coordinates[2].uv[0], glm::vec2(1, 0));
}

TEST_F(TexturedObj, KdMultipliesItsMap) {
  write_picture("wood.png", cv::Scalar(10, 100, 200));
  EXPECT_EQ(load_square("map_Kd wood.png\n").materials[0].base_color, glm::vec3(1)) << "without Kd";
  EXPECT_EQ(load_square("Kd 0.5 0.5 0.5\nmap_Kd wood.png\n").materials[0].base_color, glm::vec3(0.5f));
}

TEST_F(TexturedObj, ScaleAndOffsetCountFromTheBottom) {
  write_picture("wood grain.png", cv::Scalar(10, 100, 200));
  const Mesh mesh = load_square("map_Kd -s 2 3 1 -o 0.5 0.25 wood grain.png\n");
  // The corner (1, 1) of the file, its picture's upper right, goes to 2 * 1 + 0.5 and 3 * 1 + 0.25 from the bottom.
  const glm::vec3 place = mesh.materials[0].base_color_texture.uv_transform * glm::vec3(mesh.texture_coordinates[2].uv[0], 1);
  EXPECT_LT(glm::distance(place, glm::vec3(2.5f, 1 - 3.25f, 1)), 1e-6f);
}

TEST_F(TexturedObj, BumpMapsAreNormalsOrNamed) {
  write_picture("n.png", cv::Scalar(255, 128, 128));
  write_picture("h.png", cv::Scalar(128, 128, 128));
  const Mesh mesh = load_square("map_Bump -bm 0.5 n.png\n");
  EXPECT_EQ(mesh.materials[0].normal_texture.strength, 0.5f);
  EXPECT_FALSE(texture(mesh, mesh.materials[0].normal_texture).is_srgb);
  EXPECT_EQ(mesh.texture_coordinates[0].tangent, glm::vec4(1, 0, 0, 1));
  warnings_.all.clear();
  EXPECT_FALSE(load_square("map_Bump -bm 0.5 h.png\n").materials[0].normal_texture.is_used());
  EXPECT_THAT(warnings_.all, testing::Contains(HasSubstr("the bump map \"h.png\" is one of heights")));
}

TEST_F(TexturedObj, FoldersOfAnotherMachineAreLookedForBesideTheLibrary) {
  write_picture("wood.png", cv::Scalar(10, 100, 200));
  EXPECT_TRUE(load_square("map_Kd C:\\Users\\me\\wood.png\n").has_textures());
  EXPECT_TRUE(load_square("map_Kd /home/me/textures/wood.png\n").has_textures());
}

TEST_F(TexturedObj, WhatIsWrongIsSaidAndTheRestDrawn) {
  EXPECT_FALSE(load_square("map_Kd none.png\n").has_textures());
  EXPECT_THAT(warnings_.all, ElementsAre(AllOf(HasSubstr("a.mtl: its texture \"none.png\" is not there"))));
  write_text(folder_ / "text.png", "no picture");
  warnings_.all.clear();
  EXPECT_FALSE(load_square("map_Kd text.png\n").has_textures());
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("\"text.png\" cannot be decoded")));
  EXPECT_THAT(error_of([&] { load_square("map_Kd\n"); }), AllOf(HasSubstr("a.mtl:2:"), HasSubstr("names no picture")));
}

TEST_F(TexturedObj, FacesWithoutTextureCoordinatesAreUntextured) {
  write_picture("wood.png", cv::Scalar(10, 100, 200));
  const Mesh mesh = load_square("map_Kd wood.png\n", "f 1/1 2/2 3/3\nf 1 3 4\n");
  EXPECT_TRUE(mesh.materials[mesh.triangle_material[0]].has_textures());
  EXPECT_FALSE(mesh.materials[mesh.triangle_material[1]].has_textures());
  EXPECT_THAT(warnings_.all, testing::Contains(HasSubstr("faces without texture coordinates")));
}

TEST_F(TexturedObj, OpacityIsRead) {
  const Mesh mesh = load_square("d 0.25\n");
  EXPECT_EQ(mesh.materials[0].alpha_mode, AlphaMode::blend);
  EXPECT_EQ(mesh.materials[0].opacity, 0.25f);
  EXPECT_EQ(load_square("Tr 0.25\n").materials[0].opacity, 0.75f);
}

TEST_F(TexturedObj, NamesItsPictures) {
  write_picture("wood.png", cv::Scalar(10, 100, 200));
  load_square("map_Kd -s 2 2 wood.png\nmap_Ke none.png\n");
  EXPECT_THAT(files_of_mesh(folder_ / "a.obj"), ElementsAre(folder_ / "a.obj", folder_ / "a.mtl", folder_ / "wood.png"));
}

}  // namespace
}  // namespace catchlight::render
