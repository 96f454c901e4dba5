// Where the sun stands, by date and place.
#pragma once

#include <optional>
#include <string_view>

namespace catchlight::render {

struct SunPosition {
  double elevation_deg;  ///< without the air's refraction, which lifts a sun on the horizon by half a degree
  double azimuth_deg;    ///< from north over east, 0 to 360
};

/// By the Astronomical Almanac's formula of low precision: within 0.02 degrees from 1950 to 2050. `time_s`: since 1970, UTC; east
/// is positive.
SunPosition sun_position(double time_s, double latitude_deg, double longitude_deg);

/// Seconds since 1970 of "2026-06-21T12:00Z", "2026-06-21T12:00:30+02:00"; empty for anything else.
std::optional<double> time_from_text(std::string_view text);

}  // namespace catchlight::render
