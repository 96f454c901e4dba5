// Light probes that need no file: made by name, for who has no probe of the place.
#pragma once

#include <array>
#include <string>

#include "render/probe/probe.hpp"

namespace catchlight::render {

inline constexpr std::array kMadeProbes{"overcast", "studio", "sky"};

/// Whether the name is one of kMadeProbes; of the sky also with values, as "sky:sun_elevation_deg=35,turbidity=3".
bool is_made_probe(const std::string& name);

/// The probe of that name, the same on every call: a latlong of 1024 x 512, in whose light a white horizontal surface has
/// luminance 1. Below the horizon lies grey ground in that light.
///   overcast  CIE's overcast sky
///   studio    three softboxes in a dark room: key on the left, fill on the right, rim behind
///   sky       a clear sky with its sun (sky.hpp), by sun_elevation_deg and sun_azimuth_deg, or by date, latitude_deg and
///             longitude_deg; and turbidity. North is probe -z and east is +x, as on a map whose top is the tag's far side
/// Throws Error that begins with the name: an unknown one, a bad value, or a sun below the horizon.
Probe make_probe(const std::string& name);

}  // namespace catchlight::render
