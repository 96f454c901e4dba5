#include "render/made_probe/sun_position.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace catchlight::render {
namespace {

SunPosition sun(const char* time, double latitude_deg, double longitude_deg) {
  return sun_position(time_from_text(time).value(), latitude_deg, longitude_deg);
}

// I. Reda and A. Andreas, "Solar Position Algorithm", NREL/TP-560-34302, table A5.1; refraction lifts the sun by 0.016 there.
TEST(SunPosition, IsThatOfNrelsExample) {
  const SunPosition at = sun("2003-10-17T12:30:30-07:00", 39.742476, -105.1786);
  EXPECT_NEAR(at.elevation_deg, 39.872, 0.01);
  EXPECT_NEAR(at.azimuth_deg, 194.340, 0.02);
}

// At a pole the sun's elevation is its declination, which is 0 at the equinoxes and the ecliptic's tilt at the solstices.
TEST(SunPosition, CrossesTheEquatorAtTheEquinoxes) {
  EXPECT_NEAR(sun("2026-03-20T14:46Z", 90, 0).elevation_deg, 0, 0.01);
  EXPECT_NEAR(sun("2026-09-23T00:05Z", 90, 0).elevation_deg, 0, 0.01);
  EXPECT_NEAR(sun("2026-06-21T08:24Z", 90, 0).elevation_deg, 23.44, 0.01);
  EXPECT_NEAR(sun("2026-12-21T20:50Z", -90, 0).elevation_deg, 23.44, 0.01);
}

// J. Meeus, "Astronomical Algorithms", example 25.a: declination -7.785 degrees.
TEST(SunPosition, HasTheDeclinationOfMeeussExample) {
  EXPECT_NEAR(sun("1992-10-12T23:59Z", 90, 0).elevation_deg, -7.785, 0.01);
}

// The equation of time: sundials are 16.4 minutes fast on 3 November and 14.2 slow on 11 February.
TEST(SunPosition, CulminatesByTheEquationOfTime) {
  EXPECT_NEAR(sun("2026-11-03T11:43:34Z", 51.48, 0).azimuth_deg, 180, 0.06);
  EXPECT_NEAR(sun("2026-02-11T12:14:13Z", 51.48, 0).azimuth_deg, 180, 0.06);
  EXPECT_NEAR(sun("2026-11-03T10:43:34Z", 51.48, 15).azimuth_deg, 180, 0.06) << "an hour earlier a time zone to the east";
  const double south = sun("2026-02-11T12:14:13Z", -51.48, 0).azimuth_deg;
  EXPECT_NEAR(std::remainder(south, 360), 0, 0.1) << "in the north, seen from the south";
}

TEST(SunPosition, RisesInTheEastAtAnEquinox) {
  EXPECT_NEAR(sun("2026-03-20T06:07Z", 0, 0).azimuth_deg, 90, 0.3);
  EXPECT_NEAR(sun("2026-03-20T18:07Z", 0, 0).azimuth_deg, 270, 0.3);
}

TEST(TimeFromText, ReadsZonesAndRefusesTheRest) {
  EXPECT_EQ(time_from_text("1970-01-01T00:00Z"), 0);
  EXPECT_EQ(time_from_text("2000-01-01T12:00:05Z"), 946728005);
  EXPECT_EQ(time_from_text("2026-06-21T14:00+02:00"), time_from_text("2026-06-21T12:00Z"));
  EXPECT_EQ(time_from_text("2026-06-21T06:30-05:30"), time_from_text("2026-06-21T12:00Z"));
  for (const std::string text :
       {"", "2026-06-21", "2026-06-21T12:00", "2026-02-30T12:00Z", "2026-13-01T12:00Z", "2026-06-21T24:00Z", "2026-06-21T12:60Z",
        "2026-06-21 12:00Z", "2026-6-21T12:00Z", "2026-06-21T12:00Zx", "2026-06-21T12:00+2:00", "+026-06-21T12:00Z"})
    EXPECT_FALSE(time_from_text(text)) << text;
}

}  // namespace
}  // namespace catchlight::render
