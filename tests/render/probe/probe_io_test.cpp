#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/image/image_io.hpp"
#include "render/probe/probe.hpp"
#include "tests/support/test_files.hpp"

namespace catchlight::render {
namespace {

Probe even_probe(ProbeLayout layout, int width, int height, float value) {
  Probe probe{Image(width, height), layout};
  for (float& v : probe.image.data) v = value;
  return probe;
}

void write_floats(const std::string& path, const Image& image) {
  write_exr(path, {{"", &image, {"R", "G", "B"}, true}});
}

class ProbeFile : public testing::Test {
 protected:
  Probe load(const std::string& name, ProbeLoadOptions options = {}) {
    return load_probe(folder_ / name, options, warnings_.handler());
  }
  std::string load_error(const std::string& name, ProbeLoadOptions options = {}) {
    return error_of([&] { load(name, options); });
  }

  TempFolder folder_;
  Warnings warnings_;
};

TEST_F(ProbeFile, LayoutComesFromTheEnvmapAttribute) {
  save_probe(folder_ / "latlong.exr", even_probe(ProbeLayout::latlong, 30, 20, 1));  // not 2 : 1
  save_probe(folder_ / "cube.exr", even_probe(ProbeLayout::cube, 8, 48, 1));
  EXPECT_EQ(load("latlong.exr").layout, ProbeLayout::latlong);
  EXPECT_EQ(load("cube.exr").layout, ProbeLayout::cube);
}

TEST_F(ProbeFile, LayoutComesElseFromTheShape) {
  write_floats(folder_ / "two_to_one.exr", Image(32, 16));
  write_floats(folder_ / "cross.exr", Image(24, 32));
  write_floats(folder_ / "cube.exr", Image(4, 24));
  EXPECT_EQ(load("two_to_one.exr").layout, ProbeLayout::latlong);
  EXPECT_EQ(load("cross.exr").layout, ProbeLayout::cube_cross);
  EXPECT_EQ(load("cube.exr").layout, ProbeLayout::cube);
}

TEST_F(ProbeFile, SquareImagesMustBeNamed) {
  write_floats(folder_ / "square.exr", Image(16, 16));
  EXPECT_NE(load_error("square.exr").find("mirror-ball"), std::string::npos);
  EXPECT_EQ(load("square.exr", {ProbeLayout::angular}).layout, ProbeLayout::angular);
  EXPECT_EQ(load("square.exr", {ProbeLayout::mirror_ball}).layout, ProbeLayout::mirror_ball);
}

/// Drawn out to twice its width, a ball would light from wrong directions.
TEST_F(ProbeFile, SquareImagesAreNoLatlong) {
  write_floats(folder_ / "square.exr", Image(16, 16));
  const std::string error = load_error("square.exr", {ProbeLayout::latlong});
  for (const char* part : {"16 x 16 texels are square", "\"mirror-ball\"", "probe.layout", "--layout-in"})
    EXPECT_NE(error.find(part), std::string::npos) << error;
}

TEST_F(ProbeFile, WhatWasSavedKnowsItsLayout) {
  for (const std::string& name : name_list<ProbeLayout>()) {
    const ProbeLayout layout = probe_layout_from_name(name);
    const Probe probe = convert(even_probe(ProbeLayout::latlong, 32, 16, 1), layout, 12);
    for (const char* extension : {".exr", ".hdr"}) {
      save_probe(folder_ / (name + extension), probe);
      EXPECT_EQ(load(name + extension).layout, layout) << name << extension;
    }
  }
  save_probe(folder_ / "ball.exr", even_probe(ProbeLayout::mirror_ball, 16, 16, 1));
  EXPECT_EQ(load("ball.exr", {ProbeLayout::angular}).layout, ProbeLayout::angular) << "what is asked for goes first";
}

/// Red, green and blue are x, y and z of the direction, so that each texel says where it belongs.
Image faces_with_their_directions(int columns, int rows, const std::array<glm::ivec2, 6>& places) {
  constexpr int kSize = 4;
  Image image(columns * kSize, rows * kSize);
  for (std::size_t i = 0; i < 6; ++i) {
    const CubeFace& face = gl_cube_faces()[i];
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double s = (2 * x + 1.0) / kSize - 1, t = (2 * y + 1.0) / kSize - 1;
        const glm::dvec3 direction = glm::normalize(face.centre + s * face.right + t * face.down);
        for (int c = 0; c < 3; ++c)
          image.pixel(places[i].x * kSize + x, places[i].y * kSize + y)[c] = static_cast<float>(direction[c] + 2);
      }
  }
  return image;
}

TEST_F(ProbeFile, LyingCrossesAndRowsOfFacesAreRead) {
  write_floats(folder_ / "lying.exr", faces_with_their_directions(4, 3, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}}));
  write_floats(folder_ / "row.exr", faces_with_their_directions(6, 1, {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}}));
  for (const char* name : {"lying.exr", "row.exr"}) {
    const Probe probe = load(name);
    EXPECT_EQ(probe.layout, ProbeLayout::cube_cross);
    int lit = 0;
    for (int y = 0; y < probe.image.height; ++y)
      for (int x = 0; x < probe.image.width; ++x)
        if (const auto direction = direction_from_texel(probe.layout, probe.image.width, probe.image.height, x, y)) {
          ++lit;
          for (int c = 0; c < 3; ++c) EXPECT_NEAR(probe.image.pixel(x, y)[c], (*direction)[c] + 2, 1e-6) << name;
        }
    EXPECT_EQ(lit, 6 * 4 * 4);
  }
}

TEST(MirroredProbe, HasTheLightOfMinusXAtX) {
  for (const std::string& name : name_list<ProbeLayout>()) {
    Probe probe = convert(even_probe(ProbeLayout::latlong, 32, 16, 1), probe_layout_from_name(name), 12);
    for (int y = 0; y < probe.image.height; ++y)
      for (int x = 0; x < probe.image.width; ++x) {
        const auto direction = direction_from_texel(probe.layout, probe.image.width, probe.image.height, x, y);
        for (int c = 0; direction && c < 3; ++c) probe.image.pixel(x, y)[c] = static_cast<float>((*direction)[c] + 2);
      }
    const Probe other = mirrored(probe);
    for (const glm::dvec3& towards : {glm::dvec3(1, 0.3, 0.2), glm::dvec3(-0.3, 1, 0.1), glm::dvec3(-0.4, -0.2, -1)}) {
      const glm::vec3 seen = sample(probe, glm::normalize(towards)),
                      there = sample(other, glm::normalize(towards * glm::dvec3(-1, 1, 1)));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], there[c], 1e-5) << name;
    }
    EXPECT_EQ(mirrored(other).image.data, probe.image.data) << name;
  }
}

TEST_F(ProbeFile, LayoutThatDoesNotFitIsRefused) {
  write_floats(folder_ / "wide.exr", Image(32, 16));
  EXPECT_NE(load_error("wide.exr", {ProbeLayout::angular}).find("square"), std::string::npos);
  EXPECT_NE(load_error("wide.exr", {ProbeLayout::cube_cross}), "");
  EXPECT_NE(load_error("wide.exr", {ProbeLayout::cube}), "");
  write_floats(folder_ / "dot.exr", Image(1, 1));
  EXPECT_NE(load_error("dot.exr", {ProbeLayout::latlong}).find("1 x 1"), std::string::npos);
}

TEST_F(ProbeFile, BadTexelsAreCountedNamedAndTakenAsZero) {
  Image image(8, 4);
  for (float& v : image.data) v = 1;
  image.pixel(3, 1)[1] = std::numeric_limits<float>::quiet_NaN();
  image.pixel(5, 1)[0] = -2;
  image.pixel(2, 2)[2] = std::numeric_limits<float>::infinity();
  write_floats(folder_ / "bad.exr", image);
  const Probe probe = load("bad.exr");
  ASSERT_EQ(warnings_.all.size(), 1u);
  EXPECT_NE(warnings_.all[0].find("3 texels"), std::string::npos) << warnings_.all[0];
  EXPECT_NE(warnings_.all[0].find("(3, 1)"), std::string::npos) << warnings_.all[0];
  EXPECT_EQ(probe.image.pixel(3, 1)[1], 0);
  EXPECT_EQ(probe.image.pixel(3, 1)[0], 1) << "the channels beside it stay";
  EXPECT_EQ(probe.image.pixel(5, 1)[0], 0);
  EXPECT_EQ(probe.image.pixel(2, 2)[2], 0);
}

TEST_F(ProbeFile, StrictRefusesBadTexels) {
  Image image(8, 4);
  image.pixel(3, 1)[1] = -1;
  write_floats(folder_ / "bad.exr", image);
  EXPECT_NE(load_error("bad.exr", {std::nullopt, true}).find("(3, 1)"), std::string::npos);
}

TEST_F(ProbeFile, BadTexelsOutsideTheDiscDoNotCount) {
  Image image(16, 16);
  for (float& v : image.data) v = 1;
  image.pixel(0, 0)[0] = -1;
  write_floats(folder_ / "ball.exr", image);
  const Probe probe = load("ball.exr", {ProbeLayout::mirror_ball, true});
  EXPECT_EQ(probe.image.pixel(0, 0)[1], 0);
}

TEST_F(ProbeFile, BlackProbeIsWarnedAbout) {
  write_floats(folder_ / "black.exr", Image(8, 4));
  load("black.exr");
  ASSERT_EQ(warnings_.all.size(), 1u);
  EXPECT_NE(warnings_.all[0].find("black"), std::string::npos);
}

TEST_F(ProbeFile, DisplayPicturesAreRefused) {
  cv::imwrite(folder_ / "ldr.png", cv::Mat(16, 32, CV_8UC3));
  cv::imwrite(folder_ / "ldr.jpg", cv::Mat(16, 32, CV_8UC3));
  std::filesystem::copy(folder_ / "ldr.png", folder_ / "disguised.exr");
  for (const char* name : {"ldr.png", "ldr.jpg", "disguised.exr"}) {
    EXPECT_NE(load_error(name).find("high dynamic range"), std::string::npos) << name;
  }
}

TEST_F(ProbeFile, MissingForeignOrFolderIsNamed) {
  write_text(folder_ / "text.exr", "hello");
  std::filesystem::create_directories(folder_ / "folder.exr");
  for (const char* name : {"none.exr", "text.exr", "folder.exr"}) EXPECT_NE(load_error(name).find(name), std::string::npos);
}

TEST_F(ProbeFile, SeamsAreWeldedWithoutLosingLight) {
  Image image(16, 8);
  image.pixel(5, 0)[0] = 15;  // one texel of the pole's row
  image.pixel(0, 4)[1] = 2;   // one of the two columns of 180 degrees
  write_floats(folder_ / "a.exr", image);
  const Probe plain{image, ProbeLayout::latlong}, welded = load("a.exr");
  for (int x = 0; x < 16; ++x) EXPECT_NEAR(welded.image.pixel(x, 0)[0], 1, 1e-6) << "15 columns, the outer ones half as wide";
  EXPECT_EQ(welded.image.pixel(0, 4)[1], 1);
  EXPECT_EQ(welded.image.pixel(15, 4)[1], 1);
  const glm::vec3 before = project_to_sh(plain, 1)[0], after = project_to_sh(welded, 1)[0];
  EXPECT_LT(glm::distance(before, after), 1e-6f);
}

TEST_F(ProbeFile, SunBeyondHalfIsKeptInFloat) {
  Probe probe = even_probe(ProbeLayout::latlong, 16, 8, 1);
  probe.image.pixel(4, 3)[0] = 1e6f;
  save_probe(folder_ / "sun.exr", probe);
  EXPECT_EQ(load("sun.exr").image.pixel(4, 3)[0], 1e6f);
}

TEST_F(ProbeFile, RadianceRoundTrips) {
  Probe probe = even_probe(ProbeLayout::latlong, 16, 8, 0.5f);
  save_probe(folder_ / "a.hdr", probe);
  EXPECT_EQ(load("a.hdr").image.data, probe.image.data);
}

TEST_F(ProbeFile, UnknownEndingIsAUsageError) {
  EXPECT_THROW(save_probe(folder_ / "a.png", even_probe(ProbeLayout::latlong, 8, 4, 1)), UsageError);
}

// Probes made by other programs, where the machine has them.

TEST(RealProbes, BlendersStudioLightsLoadAndLight) {
  const std::filesystem::path folder = "/usr/share/blender/datafiles/studiolights/world";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "Debian's blender-data is not installed";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".exr") continue;
    Warnings warnings;
    const Probe probe = load_probe(entry.path(), {}, warnings.handler());
    EXPECT_EQ(probe.layout, ProbeLayout::latlong);
    const glm::dvec3 sky = irradiance(probe, {0, 1, 0});
    EXPECT_TRUE(sky.y > 0.01 && sky.y < 1000) << entry.path() << ": " << sky.y;
    // Each part of the light errs by at most 3/32 of its flux in nine coefficients (see
    // OfASunWithNineCoefficientsStaysWithinTheBound).
    const ShRgb light = project_to_sh(probe, 3);
    const double flux = light[0].y * 2 * std::sqrt(std::numbers::pi);
    const glm::dvec3 nine = irradiance_over_pi(light, {0, 1, 0}) * std::numbers::pi;
    EXPECT_LT(std::abs(nine.y - sky.y), 3.0 / 32 * flux) << entry.path();
  }
}

TEST(RealProbes, AngularMapAndMirrorBallOfOnePlaceAgree) {
  // Made from the same latlong probe; the angular maps look along -z: what angular-inside says, and read as angular, their +z is
  // the ball's -z.
  const std::filesystem::path folder = footage_folder() / "probes" / "derived";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no footage: set CATCHLIGHT_FOOTAGE";
  for (const std::string name : {"city", "interior", "studio"}) {
    const Probe angular = load_probe(folder / (name + "_angular.hdr"), {ProbeLayout::angular}, {});
    const Probe ball = load_probe(folder / (name + "_mirrorball.hdr"), {ProbeLayout::mirror_ball}, {});
    const Probe inside = load_probe(folder / (name + "_angular.hdr"), {ProbeLayout::angular_inside}, {});
    for (const glm::dvec3& normal :
         {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1)}) {
      const glm::dvec3 of_angular = irradiance(angular, {normal.x, normal.y, -normal.z}), of_ball = irradiance(ball, normal);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(of_angular[c] / of_ball[c], 1, 0.05) << name;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance(inside, normal)[c] / of_ball[c], 1, 0.05) << name;
    }
  }
}

TEST(RealProbes, RadianceLatlongsLoad) {
  const std::filesystem::path folder = footage_folder() / "probes" / "latlong";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no footage: set CATCHLIGHT_FOOTAGE";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    Warnings warnings;
    const Probe probe = load_probe(entry.path(), {}, warnings.handler());
    EXPECT_EQ(probe.image.width, 2 * probe.image.height);
    EXPECT_TRUE(warnings.all.empty());
    EXPECT_GT(irradiance(probe, {0, 1, 0}).y, 0);
  }
}

}  // namespace
}  // namespace catchlight::render
