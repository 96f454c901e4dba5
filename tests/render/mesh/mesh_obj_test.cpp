// What is read of Wavefront's OBJ, and what is refused.
#include "catchlight/color.hpp"
#include "render/mesh/mesh_file.hpp"
#include "render/mesh/mesh_import.hpp"
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
  write_text(
      folder_ / "a.mtl",
      "newmtl a\nd 0.2\nmap_Kd -s 2 2 2 a.png\nPc 0.5\nnewmtl b\nd 0.5\nTr 0\nPc 0\nnewmtl c\nd 1\nmap_Kd b.png\nbump c.png\n");
  load("mtllib a.mtl\n" + kSquare + "l 1 2\nl 2 3\np 1\nf 1 2\nusemtl a\nf 1 2 3\n");
  EXPECT_THAT(warnings_.all, ElementsAre(AllOf(HasSubstr("a.obj: transparency (d)"), HasSubstr("(material \"a\", \"b\")")),
                                         AllOf(HasSubstr("maps (map_Kd)"), HasSubstr("(material \"a\", \"c\")")),
                                         HasSubstr("clear coat"), AllOf(HasSubstr("maps (bump)"), HasSubstr("\"c\"")),
                                         HasSubstr("points and lines are left out"), HasSubstr("fewer than three corners")));
}

}  // namespace
}  // namespace catchlight::render
