#include "render/probe/probe.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"

#include <gtest/gtest.h>

#include <OpenEXR/ImfEnvmap.h>

#include <cmath>
#include <numbers>
#include <random>

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

struct Shape {
  ProbeLayout layout;
  int width, height;
};

std::ostream& operator<<(std::ostream& out, const Shape& shape) {
  return out << name_of(shape.layout) << shape.width << "x" << shape.height;
}

const Shape kShapes[] = {
    {ProbeLayout::latlong, 64, 32},        {ProbeLayout::latlong, 5, 3},     {ProbeLayout::latlong, 127, 50},
    {ProbeLayout::angular, 64, 64},        {ProbeLayout::angular, 33, 33},   {ProbeLayout::angular, 4, 4},
    {ProbeLayout::mirror_ball, 64, 64},    {ProbeLayout::mirror_ball, 5, 5}, {ProbeLayout::cube_cross, 48, 64},
    {ProbeLayout::cube_cross, 6, 8},       {ProbeLayout::cube, 16, 96},      {ProbeLayout::cube, 2, 12},
    {ProbeLayout::angular_inside, 33, 33},
};

const glm::dvec3 kAxes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

std::vector<glm::dvec3> random_directions(int count) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i)
    directions.push_back(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))));
  return directions;
}

template <typename Radiance>
Probe probe_of(const Shape& shape, const Radiance& radiance) {
  Probe probe{Image(shape.width, shape.height), shape.layout};
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x) {
      const auto direction = direction_from_texel(shape.layout, shape.width, shape.height, x, y);
      const glm::dvec3 value = direction ? radiance(*direction) : glm::dvec3(0);
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = static_cast<float>(value[c]);
    }
  }
  return probe;
}

class ProbeOfShape : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, ProbeOfShape, testing::ValuesIn(kShapes));

TEST_P(ProbeOfShape, SolidAnglesAddUpToTheSphere) {
  const Shape shape = GetParam();
  double sum = 0;
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x) sum += texel_solid_angle(shape.layout, shape.width, shape.height, x, y);
  }
  EXPECT_NEAR(sum, 4 * kPi, 1e-11);  // rounding of some thousand terms; on the coarsest disc also of the Gauss rule
}

// Grids where every direction has a nearest texel (a disc's rim has none), small enough to be filled by random directions.
class ProbeGrid : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(SmallShapes, ProbeGrid,
                         testing::Values(Shape{ProbeLayout::latlong, 5, 3}, Shape{ProbeLayout::latlong, 16, 8},
                                         Shape{ProbeLayout::cube_cross, 6, 8}, Shape{ProbeLayout::cube_cross, 15, 20},
                                         Shape{ProbeLayout::cube, 2, 12}, Shape{ProbeLayout::cube, 5, 30}));

TEST_P(ProbeGrid, SolidAngleIsTheShareOfDirectionsNearestToTheTexel) {
  const Shape shape = GetParam();
  constexpr int kDirections = 200000;
  std::vector<int> count(shape.width * shape.height);
  for (const glm::dvec3& direction : random_directions(kDirections)) {
    const glm::dvec2 at = texel_from_direction(shape.layout, shape.width, shape.height, direction);
    ++count[std::lround(at.y) * shape.width + std::lround(at.x)];
  }
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x) {
      const double share = texel_solid_angle(shape.layout, shape.width, shape.height, x, y) / (4 * kPi);
      EXPECT_NEAR(count[y * shape.width + x], kDirections * share, 5 * std::sqrt(kDirections * share * (1 - share)))
          << x << ", " << y;
    }
  }
}

TEST_P(ProbeOfShape, DirectionAndTexelAreInverse) {
  const Shape shape = GetParam();
  for (const glm::dvec3& direction : random_directions(500)) {
    const glm::dvec2 at = texel_from_direction(shape.layout, shape.width, shape.height, direction);
    const auto back = direction_from_texel(shape.layout, shape.width, shape.height, at.x, at.y);
    ASSERT_TRUE(back) << at.x << ", " << at.y;
    EXPECT_LT(glm::distance(*back, direction), 1e-7);  // a ball's rim stretches: there rounding grows by 1 / sqrt
  }
}

TEST_P(ProbeOfShape, EveryAxisHasAFinitePlace) {
  const Shape shape = GetParam();
  for (const glm::dvec3& axis : kAxes) {
    const glm::dvec2 at = texel_from_direction(shape.layout, shape.width, shape.height, axis);
    EXPECT_TRUE(std::isfinite(at.x) && std::isfinite(at.y));
    EXPECT_TRUE(at.x >= -0.5 && at.x <= shape.width - 0.5 && at.y >= -0.5 && at.y <= shape.height - 0.5) << at.x << ", " << at.y;
  }
}

TEST_P(ProbeOfShape, SampleOfAConstantIsConstantEverywhere) {
  const Probe probe = probe_of(GetParam(), [](const glm::dvec3&) { return glm::dvec3(1, 2, 3); });
  std::vector<glm::dvec3> directions = random_directions(500);
  directions.insert(directions.end(), std::begin(kAxes), std::end(kAxes));
  for (const glm::dvec3& direction : directions) {
    const glm::vec3 value = sample(probe, direction);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], c + 1, 1e-6) << "no black from outside the layout leaks in";
  }
}

TEST_P(ProbeOfShape, SampleIsContinuousAcrossSeamsAndPoles) {
  // The steepest slope allowed is that of the texels themselves: a step shows as a change that does not shrink with the distance.
  const Shape shape = GetParam();
  const Probe probe = probe_of(shape, [](const glm::dvec3& d) { return glm::dvec3(2 + d.x, 2 + d.y * d.z, 2 + d.z); });
  constexpr double kStep = 1e-7;
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> on_seams(std::begin(kAxes), std::end(kAxes));
  for (int i = 0; i < 400; ++i) {
    const double t = normal(random), s = normal(random);
    on_seams.insert(
        on_seams.end(),
        {glm::normalize(glm::dvec3(0, t, -std::abs(s))),  // +-180 degrees
         glm::normalize(glm::dvec3(1, i % 2 ? 1 : -1, std::tanh(t))), glm::normalize(glm::dvec3(std::tanh(t), 1, 1)),
         glm::normalize(glm::dvec3(-1, std::tanh(t), i % 2 ? 1 : -1)), glm::normalize(glm::dvec3(1, 1, i % 2 ? 1 : -1))});
  }
  for (const glm::dvec3& direction : on_seams) {
    const glm::dvec3 aside(normal(random), normal(random), normal(random));
    const glm::vec3 one = sample(probe, glm::normalize(direction + kStep * aside)),
                    other = sample(probe, glm::normalize(direction - kStep * aside));
    EXPECT_LT(glm::distance(one, other), 1e-3f) << direction.x << ", " << direction.y << ", " << direction.z;
  }
}

TEST_P(ProbeOfShape, ConstantLightProjectsToItsFirstCoefficient) {
  const Probe probe = probe_of(GetParam(), [](const glm::dvec3&) { return glm::dvec3(1, 0.5, 0.25); });
  const ShRgb light = project_to_sh(probe, 1);
  EXPECT_NEAR(light[0].x, 2 * std::sqrt(kPi), 1e-6);
  EXPECT_NEAR(light[0].z, 2 * std::sqrt(kPi) / 4, 1e-6);
}

TEST(ProbeLayoutNames, RoundTrip) {
  for (const ProbeLayout layout :
       {ProbeLayout::latlong, ProbeLayout::angular, ProbeLayout::mirror_ball, ProbeLayout::cube_cross, ProbeLayout::cube}) {
    EXPECT_EQ(probe_layout_from_name(name_of(layout)), layout);
  }
  EXPECT_THROW(probe_layout_from_name("spherical"), Error);
}

TEST(LatlongLayout, AgreesWithOpenExr) {
  const Imath::Box2i window({0, 0}, {63, 31});
  for (const glm::dvec3& direction : random_directions(500)) {
    const Imath::V2f expected = Imf::LatLongMap::pixelPosition(window, Imath::V3f(direction.x, direction.y, direction.z));
    const glm::dvec2 at = texel_from_direction(ProbeLayout::latlong, 64, 32, direction);
    EXPECT_NEAR(at.x, expected.x, 1e-4);  // OpenEXR computes in float
    EXPECT_NEAR(at.y, expected.y, 1e-4);
  }
}

TEST(CubeLayout, AgreesWithOpenExr) {
  const Imath::Box2i window({0, 0}, {15, 95});
  for (const glm::dvec3& direction : random_directions(500)) {
    Imf::CubeMapFace face;
    Imath::V2f in_face;
    Imf::CubeMap::faceAndPixelPosition(Imath::V3f(direction.x, direction.y, direction.z), window, face, in_face);
    const Imath::V2f expected = Imf::CubeMap::pixelPosition(face, window, in_face);
    const glm::dvec2 at = texel_from_direction(ProbeLayout::cube, 16, 96, direction);
    EXPECT_NEAR(at.x, expected.x, 1e-4);
    EXPECT_NEAR(at.y, expected.y, 1e-4);
  }
}

TEST(LatlongLayout, PlacesTheAxes) {
  const auto at = [](const glm::dvec3& direction) { return texel_from_direction(ProbeLayout::latlong, 9, 5, direction); };
  EXPECT_EQ(at({0, 0, 1}), glm::dvec2(4, 2));
  EXPECT_EQ(at({1, 0, 0}), glm::dvec2(2, 2));  // +90 degrees, left of the middle
  EXPECT_EQ(at({-1, 0, 0}), glm::dvec2(6, 2));
  EXPECT_DOUBLE_EQ(at({0, 1, 0}).y, 0);
  EXPECT_DOUBLE_EQ(at({0, -1, 0}).y, 4);
}

TEST(AngularLayout, IsDebevecsFormula) {
  for (const glm::dvec3& d : random_directions(200)) {
    const double r = std::acos(d.z) / (kPi * std::sqrt(d.x * d.x + d.y * d.y));
    const glm::dvec2 at = texel_from_direction(ProbeLayout::angular, 100, 100, d);
    EXPECT_NEAR(at.x, (d.x * r + 1) * 50 - 0.5, 1e-9);
    EXPECT_NEAR(at.y, (1 - d.y * r) * 50 - 0.5, 1e-9);
  }
}

TEST(AngularLayout, StraightBackIsTheMeanOfItsRim) {
  Probe probe =
      probe_of({ProbeLayout::angular, 64, 64}, [](const glm::dvec3& d) { return glm::dvec3(d.z < -0.9 ? d.x + 2 : 0.0); });
  const float back = sample(probe, {0, 0, -1}).x;
  for (int k = 0; k < 16; ++k) {
    const double phi = 2 * kPi * k / 16;
    const glm::dvec3 near_back = glm::normalize(glm::dvec3(1e-6 * std::cos(phi), 1e-6 * std::sin(phi), -1));
    EXPECT_NEAR(sample(probe, near_back).x, back, 1e-4);
  }
  EXPECT_NEAR(back, 2, 0.05);
}

TEST(MirrorBallLayout, IsTheReflectionOnASphere) {
  // The viewer looks along -z from far away; the ball's point with normal n reflects to 2 (n . z) n - z.
  for (const glm::dvec2& at : {glm::dvec2(10, 70), glm::dvec2(49.5, 49.5), glm::dvec2(80, 30), glm::dvec2(2, 50)}) {
    const glm::dvec2 n((at.x + 0.5) / 50 - 1, 1 - (at.y + 0.5) / 50);
    const glm::dvec3 normal(n, std::sqrt(1 - glm::dot(n, n)));
    const glm::dvec3 reflected = 2 * normal.z * normal - glm::dvec3(0, 0, 1);
    EXPECT_LT(glm::distance(*direction_from_texel(ProbeLayout::mirror_ball, 100, 100, at.x, at.y), reflected), 1e-12);
  }
}

TEST(MirrorBallLayout, HasNothingBesideTheBall) {
  EXPECT_FALSE(direction_from_texel(ProbeLayout::mirror_ball, 100, 100, 1, 1));
  EXPECT_EQ(texel_solid_angle(ProbeLayout::mirror_ball, 100, 100, 1, 1), 0);
}

TEST(CubeCrossLayout, PlacesTheFaces) {
  const auto face = [](const glm::dvec3& direction) {
    const glm::dvec2 at = texel_from_direction(ProbeLayout::cube_cross, 30, 40, direction);
    return glm::ivec2((at + 0.5) / 10.0);
  };
  EXPECT_EQ(face({0, 1, 0}), glm::ivec2(1, 0));
  EXPECT_EQ(face({-1, 0, 0}), glm::ivec2(0, 1));
  EXPECT_EQ(face({0, 0, 1}), glm::ivec2(1, 1));
  EXPECT_EQ(face({1, 0, 0}), glm::ivec2(2, 1));
  EXPECT_EQ(face({0, -1, 0}), glm::ivec2(1, 2));
  EXPECT_EQ(face({0, 0, -1}), glm::ivec2(1, 3));
}

TEST(CubeCrossLayout, FoldsAlongItsMiddleColumnAndRow) {
  // Neighbouring texels of the unfolded cross are neighbours in space.
  const auto step = [](double x0, double y0, double x1, double y1) {
    return glm::distance(*direction_from_texel(ProbeLayout::cube_cross, 300, 400, x0, y0),
                         *direction_from_texel(ProbeLayout::cube_cross, 300, 400, x1, y1));
  };
  for (const double along : {110.0, 150.0, 190.0}) {
    for (const int border : {100, 200, 300}) EXPECT_LT(step(along, border - 1, along, border), 0.02) << "column, row " << border;
    for (const int border : {100, 200}) EXPECT_LT(step(border - 1, along, border, along), 0.02) << "row, column " << border;
  }
}

// One bright spot per axis must be found there again by every route that light takes.
class BrightSpot : public testing::TestWithParam<ProbeLayout> {};
INSTANTIATE_TEST_SUITE_P(Layouts, BrightSpot,
                         testing::Values(ProbeLayout::latlong, ProbeLayout::angular, ProbeLayout::mirror_ball,
                                         ProbeLayout::cube_cross, ProbeLayout::cube, ProbeLayout::angular_inside),
                         [](const auto& tested) {
                           std::string name = name_of(tested.param);
                           std::erase(name, '-');
                           return name;
                         });

Shape fine_shape(ProbeLayout layout) {
  switch (layout) {
    case ProbeLayout::latlong:
      return {layout, 128, 64};
    case ProbeLayout::cube_cross:
      return {layout, 96, 128};
    case ProbeLayout::cube:
      return {layout, 32, 192};
    default:
      return {layout, 128, 128};
  }
}

// A patch of 0.2 rad, so that each layout holds several texels of it.
Probe spot_towards(ProbeLayout layout, const glm::dvec3& axis) {
  return probe_of(fine_shape(layout),
                  [&](const glm::dvec3& d) { return glm::dvec3(glm::dot(d, axis) > std::cos(0.2) ? 1.0 : 0.0); });
}

// A mirror ball of this size sees nothing within 10 degrees of straight back: light there is lost on the way.
bool is_blind(ProbeLayout layout, const glm::dvec3& axis) {
  return layout == ProbeLayout::mirror_ball && axis.z < -0.5;
}

TEST_P(BrightSpot, IsSampledWhereItIs) {
  for (const glm::dvec3& axis : kAxes) {
    if (is_blind(GetParam(), axis)) continue;
    const Probe probe = spot_towards(GetParam(), axis);
    for (const glm::dvec3& other : kAxes) EXPECT_NEAR(sample(probe, other).x, other == axis ? 1 : 0, 1e-3);
  }
}

TEST_P(BrightSpot, StaysThereInEveryOtherLayout) {
  for (const ProbeLayout to :
       {ProbeLayout::latlong, ProbeLayout::angular, ProbeLayout::mirror_ball, ProbeLayout::cube_cross, ProbeLayout::cube}) {
    for (const glm::dvec3& axis : kAxes) {
      if (is_blind(GetParam(), axis) || is_blind(to, axis)) continue;
      const Probe converted = convert(spot_towards(GetParam(), axis), to);
      EXPECT_EQ(converted.layout, to);
      for (const glm::dvec3& other : kAxes) EXPECT_NEAR(sample(converted, other).x, other == axis ? 1 : 0, 1e-3) << name_of(to);
    }
  }
}

TEST_P(BrightSpot, ShowsInTheSignOfBandOne) {
  for (const glm::dvec3& axis : kAxes) {
    const ShRgb light = project_to_sh(spot_towards(GetParam(), axis), 2);
    const glm::dvec3 slope(light[sh_index(1, 1)].x, light[sh_index(1, -1)].x, light[sh_index(1, 0)].x);
    EXPECT_GT(glm::dot(glm::normalize(slope), axis), 0.999);
  }
}

TEST_P(BrightSpot, KeepsItsPowerWhenConverted) {
  // 100 bright texels' worth of light, converted coarsely and finely: the total must stay.
  const Probe probe = spot_towards(GetParam(), glm::normalize(glm::dvec3(1, 0.4, 0.6)));
  const float power = project_to_sh(probe, 1)[0].x;
  for (const ProbeLayout to :
       {ProbeLayout::latlong, ProbeLayout::angular, ProbeLayout::mirror_ball, ProbeLayout::cube_cross, ProbeLayout::cube}) {
    EXPECT_NEAR(project_to_sh(convert(probe, to), 1)[0].x / power, 1, 0.02) << name_of(to);
  }
}

TEST(ProbeConversion, OfOneTexelSunKeepsItsPower) {
  Probe probe{Image(256, 128), ProbeLayout::latlong};
  probe.image.pixel(77, 40)[1] = 30000;
  const float power = project_to_sh(probe, 1)[0].y;
  for (const ProbeLayout to : {ProbeLayout::angular, ProbeLayout::mirror_ball, ProbeLayout::cube_cross, ProbeLayout::cube}) {
    // A quarter-texel grid of samples integrates one bilinear tent to a few per cent.
    EXPECT_NEAR(project_to_sh(convert(probe, to), 1)[0].y / power, 1, 0.1) << name_of(to);
    EXPECT_NEAR(project_to_sh(convert(probe, to, to == ProbeLayout::cube_cross ? 24 : 16), 1)[0].y / power, 1, 0.1)
        << "coarse " << name_of(to);
  }
}

TEST(ProbeConversion, RefusesAWidthThatCannotBe) {
  const Probe probe{Image(64, 32), ProbeLayout::latlong};
  EXPECT_THROW(convert(probe, ProbeLayout::cube_cross, 100), Error);
  EXPECT_THROW(convert(probe, ProbeLayout::angular, 2), Error);
}

TEST(TagFromProbe, PutsProbeUpWhereTheTagsUpIs) {
  const glm::dmat3 table = tag_from_probe(UpAxis::z, 0), wall = tag_from_probe(UpAxis::y, 0);
  EXPECT_LT(glm::distance(table * glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)), 1e-15);
  EXPECT_LT(glm::distance(table * glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0)), 1e-15);
  EXPECT_LT(glm::distance(table * glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0)), 1e-15);
  EXPECT_EQ(wall, glm::dmat3(1));
}

TEST(TagFromProbe, YawTurnsCounterClockwiseSeenFromAbove) {
  EXPECT_LT(glm::distance(tag_from_probe(UpAxis::z, 90) * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)), 1e-15);
  EXPECT_LT(glm::distance(tag_from_probe(UpAxis::y, 90) * glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)), 1e-15);
  EXPECT_NEAR(glm::determinant(tag_from_probe(UpAxis::z, 33)), 1, 1e-15);
  EXPECT_EQ(value_named<UpAxis>("x"), std::nullopt);
}

TEST(ProbeIrradiance, OfAConstantProbeIsPi) {
  const Probe probe = probe_of({ProbeLayout::latlong, 256, 128}, [](const glm::dvec3&) { return glm::dvec3(1); });
  for (const glm::dvec3& normal : random_directions(10))
    EXPECT_NEAR(irradiance(probe, normal).x, kPi, 1e-3);  // texels on the horizon
}

TEST(ProbeIrradiance, OfASmoothProbeIsWhatNineCoefficientsGive) {
  // Light of degree <= 2 has no more than 9 coefficients, so irradiance is exact in them; what is left is the sum over texels.
  const Probe probe = probe_of({ProbeLayout::latlong, 256, 128},
                               [](const glm::dvec3& d) { return glm::dvec3(2 + d.x + d.y * d.z, 1 + d.z, 1 + d.x * d.x); });
  const ShRgb light = project_to_sh(probe, 3);
  for (const glm::dvec3& normal : random_directions(20)) {
    const glm::dvec3 exact = irradiance(probe, normal) / kPi, nine = irradiance_over_pi(light, normal);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(nine[c] / exact[c], 1, 1e-3);
  }
}

TEST(ProbeIrradiance, OfASunWithNineCoefficientsStaysWithinTheBound) {
  // Under one sun 3 bands make 1/4 + cos/2 + 5/32 (3 cos^2 - 1) out of max(cos, 0): at most 3/32 off, at the horizon. No light is
  // worse, as every light is made of suns.
  Probe probe{Image(256, 128), ProbeLayout::latlong};
  probe.image.pixel(100, 30)[0] = 10000;
  const ShRgb light = project_to_sh(probe, 3);
  const glm::dvec3 sun = *direction_from_texel(ProbeLayout::latlong, 256, 128, 100, 30);
  const double largest = irradiance(probe, sun).x;
  for (const glm::dvec3& normal : random_directions(200)) {
    EXPECT_LT(std::abs(irradiance_over_pi(light, normal).x * kPi - irradiance(probe, normal).x) / largest, 3.0 / 32 + 1e-3);
  }
}

}  // namespace
}  // namespace catchlight::render
