// Pictures made of pictures.
#include "app/window/picture/false_colors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "catchlight/color.hpp"

namespace catchlight::tests {
namespace {

using namespace catchlight::app;

/// One grey pixel of that linear value.
RgbPicture grey(double linear) {
  const auto code = static_cast<unsigned char>(std::lround(255 * srgb_from_linear(linear)));
  return {1, 1, {code, code, code}};
}

std::string zone_of(const RgbPicture& picture) {
  const RgbPicture shown = zones(picture);
  for (const Zone& zone : exposure_zones())
    if (std::equal(zone.rgb.begin(), zone.rgb.end(), shown.rgb.begin())) return zone.meaning;
  return "none";
}

TEST(Zones, AreStopsAroundMidGrey) {
  EXPECT_EQ(zone_of(grey(0.18)), "mid grey");
  EXPECT_EQ(zone_of(grey(0.36)), "+1");
  EXPECT_EQ(zone_of(grey(0.72)), "+2");
  EXPECT_EQ(zone_of(grey(0.09)), "−1");
  EXPECT_EQ(zone_of(grey(0.18 / 16)), "−4");
}

TEST(Zones, ClippedIsWhereOneChannelIs) {
  EXPECT_EQ(zone_of({1, 1, {255, 10, 10}}), "clipped");
  EXPECT_EQ(zone_of({1, 1, {1, 0, 1}}), "black");
}

TEST(Zones, NoTwoShareAColour) {
  for (const Zone& one : exposure_zones())
    EXPECT_EQ(std::ranges::count_if(exposure_zones(), [&](const Zone& other) { return other.rgb == one.rgb; }), 1) << one.meaning;
}

TEST(Difference, IsEnlargedAroundMidGreyAndCutOff) {
  const RgbPicture a{1, 1, {100, 110, 250}}, b{1, 1, {100, 108, 5}};
  EXPECT_EQ(difference(a, b, 8).rgb, (std::vector<unsigned char>{128, 144, 255}));
  EXPECT_EQ(difference(b, a, 8).rgb, (std::vector<unsigned char>{128, 112, 0}));
}

}  // namespace
}  // namespace catchlight::tests
