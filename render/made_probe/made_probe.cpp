#include "render/made_probe/made_probe.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <map>

#include "catchlight/color.hpp"
#include "catchlight/util/parallel.hpp"
#include "catchlight/util/text.hpp"
#include "render/made_probe/light_shapes.hpp"
#include "render/made_probe/sky.hpp"
#include "render/made_probe/sun_position.hpp"

namespace catchlight::render {
namespace {

constexpr int kWidth = 1024, kHeight = kWidth / 2;

/// What the ground sends back of its light.
constexpr double kGroundAlbedo = 0.2;

constexpr glm::dvec3 kUp(0, 1, 0);

using Radiance = std::function<glm::dvec3(const glm::dvec3& direction)>;

/// The sky's half: rows above the horizon, which lies between two rows.
Probe upper_half(const Radiance& radiance) {
  Probe probe{Image(kWidth, kHeight), ProbeLayout::latlong};
  parallel_for(kHeight / 2, 0, [&](std::size_t y) {
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 rgb = radiance(*direction_from_texel(probe.layout, kWidth, kHeight, x, static_cast<double>(y)));
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, static_cast<int>(y))[c] = static_cast<float>(rgb[c]);
    }
  });
  return probe;
}

/// The light scaled so that white shows luminance 1 in it, over a ground in that light.
Probe over_ground(Probe probe) {
  const glm::dvec3 white = irradiance(probe, kUp) / glm::pi<double>();
  const double gain = 1 / glm::dot(kLuminanceWeights, white);
  for (float& value : probe.image.data) value = static_cast<float>(value * gain);
  const glm::vec3 ground(kGroundAlbedo * gain * white);
  for (int y = kHeight / 2; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) std::copy_n(&ground[0], 3, probe.image.pixel(x, y));
  weld_seams(probe);
  return probe;
}

Probe of_grey(double (*radiance)(const glm::dvec3&)) {
  return over_ground(upper_half([&](const glm::dvec3& direction) { return glm::dvec3(radiance(direction)); }));
}

/// The values behind a name's colon.
class Values {
 public:
  Values(const std::string& name, const std::vector<std::string>& keys) : name_(name) {
    const std::size_t colon = name.find(':');
    if (colon == std::string::npos) return;
    for (const std::string& field : split(std::string_view(name).substr(colon + 1), ',')) {
      const std::size_t equals = field.find('=');
      if (equals == std::string::npos) fail("\"" + field + "\" is no value; expected KEY=VALUE, as in sky:sun_elevation_deg=35");
      const std::string key = field.substr(0, equals);
      if (std::ranges::count(keys, key) == 0)
        fail("there is no \"" + key + "\"; did you mean \"" + nearest(key, keys) + "\"? It takes " + quoted_list(keys));
      if (!held_.emplace(key, field.substr(equals + 1)).second) fail(key + " is given twice");
    }
  }

  [[noreturn]] void fail(const std::string& why) const { throw Error(name_ + ": " + why); }
  bool has(const std::string& key) const { return held_.contains(key); }
  const std::string& text(const std::string& key) const { return held_.at(key); }

  double number(const std::string& key, double min, double max, double otherwise, const std::string& advice = "") const {
    if (!has(key)) return otherwise;
    const std::optional<double> value = real_from_text(text(key));
    if (!value || !(*value >= min && *value <= max))
      fail(key + " is " + text(key) + "; expected a number from " + plain_text(min) + " to " + plain_text(max) + advice);
    return *value;
  }

 private:
  std::string name_;
  std::map<std::string, std::string> held_;
};

constexpr const char* kBelow = "the sky's model has its sun above the horizon; \"overcast\" is nearer to what dusk is like";

SunPosition sun_by_date(const Values& values) {
  const std::optional<double> time_s = time_from_text(values.text("date"));
  if (!time_s)
    values.fail("date is " + values.text("date") +
                "; expected date, time and zone, such as 2026-06-21T12:00Z or 2026-06-21T14:00+02:00");
  for (const char* key : {"latitude_deg", "longitude_deg"})
    if (!values.has(key)) values.fail("a date needs latitude_deg and longitude_deg (north and east are positive)");
  for (const char* key : {"sun_elevation_deg", "sun_azimuth_deg"})
    if (values.has(key)) values.fail("the date says where the sun stands; leave out " + std::string(key));
  const SunPosition sun =
      sun_position(*time_s, values.number("latitude_deg", -90, 90, 0), values.number("longitude_deg", -180, 180, 0));
  if (sun.elevation_deg < 0)
    values.fail("the sun is " + fixed_text(-sun.elevation_deg, 1) + " degrees below the horizon then and there, and " + kBelow);
  return sun;
}

SunPosition sun_of(const Values& values) {
  if (values.has("date")) return sun_by_date(values);
  for (const char* key : {"latitude_deg", "longitude_deg"})
    if (values.has(key)) values.fail(std::string(key) + " needs a date, such as date=2026-06-21T12:00Z");
  return {values.number("sun_elevation_deg", 0, 90, 40, std::string("; ") + kBelow),
          values.number("sun_azimuth_deg", -360, 360, 135)};
}

Probe make_sky(const std::string& name) {
  const Values values(name, {"sun_elevation_deg", "sun_azimuth_deg", "turbidity", "date", "latitude_deg", "longitude_deg"});
  const SunPosition sun = sun_of(values);
  const double turbidity = values.number("turbidity", kMinTurbidity, kMaxTurbidity, 3);
  const double elevation = glm::radians(sun.elevation_deg), azimuth = glm::radians(sun.azimuth_deg);
  const glm::dvec3 towards(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                           -std::cos(elevation) * std::cos(azimuth));
  const ClearSky sky(turbidity, elevation);
  Probe probe = upper_half([&](const glm::dvec3& direction) {
    const double from_sun_rad = std::acos(glm::clamp(glm::dot(direction, towards), -1.0, 1.0));
    return rec709_from(sky.at(std::acos(glm::clamp(direction.y, 0.0, 1.0)), from_sun_rad));
  });
  const double disc_sr = glm::two_pi<double>() * (1 - std::cos(glm::radians(kSunDiameter_deg / 2)));
  add_disc(probe, towards, kSunDiameter_deg, rec709_from(sun_disc(turbidity, elevation)) * disc_sr);
  return over_ground(std::move(probe));
}

}  // namespace

bool is_made_probe(const std::string& name) {
  return std::ranges::count(kMadeProbes, name) > 0 || name.starts_with("sky:");
}

Probe make_probe(const std::string& name) {
  if (name == "overcast") return of_grey(overcast_radiance);
  if (name == "studio") return of_grey(studio_radiance);
  if (is_made_probe(name)) return make_sky(name);
  const std::vector<std::string> names(kMadeProbes.begin(), kMadeProbes.end());
  throw Error(name + ": no probe is made by that name; did you mean \"" + nearest(name.substr(0, name.find(':')), names) +
              "\"? There are " + quoted_list(names));
}

}  // namespace catchlight::render
