#include "render/probe/texel_rows.hpp"

#include <gtest/gtest.h>

#include <random>

namespace catchlight::render {
namespace {

glm::ivec2 size_of(ProbeLayout layout) {
  switch (layout) {
    case ProbeLayout::latlong:
      return {64, 32};
    case ProbeLayout::cube_cross:
      return {48, 64};
    case ProbeLayout::cube:
      return {16, 96};
    default:
      return {40, 40};
  }
}

constexpr ProbeLayout kLayouts[] = {ProbeLayout::latlong, ProbeLayout::angular, ProbeLayout::mirror_ball, ProbeLayout::cube_cross,
                                    ProbeLayout::cube};

TEST(TexelRows, SayWhatSingleTexelsSay) {
  for (const ProbeLayout layout : kLayouts) {
    const glm::ivec2 size = size_of(layout);
    const TexelRows texels(layout, size.x, size.y);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const auto direction = direction_from_texel(layout, size.x, size.y, x, y);
        ASSERT_EQ(texels.direction(x, y).has_value(), direction.has_value());
        if (!direction) continue;
        EXPECT_LT(glm::distance(*texels.direction(x, y), *direction), 1e-15);
        EXPECT_EQ(texels.solid_angle(x, y), texel_solid_angle(layout, size.x, size.y, x, y));
      }
    }
  }
}

TEST(TexelRows, PlacesOfManyDirectionsAreThoseOfSingleOnes) {
  std::mt19937 random(5);
  std::normal_distribution<double> spread;
  for (const ProbeLayout layout : kLayouts) {
    const glm::ivec2 size = size_of(layout) * 256;  // a latlong of 16384 x 8192: a texel is 0.4 mrad
    Coordinates3 directions(1007);
    for (std::size_t i = 0; i < directions.x.size(); ++i) {
      const double length = i % 3 == 0 ? 1 : 0.1 + 0.01 * static_cast<double>(i);
      const glm::dvec3 direction = length * glm::normalize(glm::dvec3(spread(random), spread(random), spread(random)));
      directions.x[i] = direction.x, directions.y[i] = direction.y, directions.z[i] = direction.z;
    }
    // The axes, the poles and half-way between: where cases meet.
    for (int i = 0; i < 27; ++i) {
      if (i == 13) continue;
      directions.x[i] = i % 3 - 1, directions.y[i] = i / 3 % 3 - 1, directions.z[i] = i / 9 - 1;
    }
    Coordinates2 texels(directions.x.size());
    texels_from_directions(layout, size.x, size.y, directions, texels);
    for (std::size_t i = 0; i < texels.x.size(); ++i) {
      const glm::dvec2 alone = texel_from_direction(layout, size.x, size.y, {directions.x[i], directions.y[i], directions.z[i]});
      EXPECT_LT(glm::distance(glm::dvec2(texels.x[i], texels.y[i]), alone), 1e-5) << name_of(layout) << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace catchlight::render
