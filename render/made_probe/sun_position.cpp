#include "render/made_probe/sun_position.hpp"

#include <chrono>
#include <cmath>
#include <glm/glm.hpp>

#include "catchlight/util/text.hpp"

namespace catchlight::render {
namespace {

double turned_deg(double degrees) {
  return degrees - 360 * std::floor(degrees / 360);
}

/// Reads fields of fixed width off the front of a text; `failed` once one is not what it should be.
struct Fields {
  std::string_view left;
  bool failed = false;

  int number(std::size_t digits, int min, int max) {
    const std::string_view field = left.substr(0, digits);
    const bool is_number = field.size() == digits && field.find_first_not_of("0123456789") == std::string_view::npos;
    const int value = is_number ? static_cast<int>(integer_from_text(field).value_or(-1)) : -1;
    failed |= !is_number || value < min || value > max;
    left.remove_prefix(field.size());
    return value;
  }
  bool takes(char c) {
    if (!left.starts_with(c)) return false;
    left.remove_prefix(1);
    return true;
  }
  void skip(char c) { failed |= !takes(c); }
};

/// "Z", or how far the clock is ahead of UTC.
int ahead_min(Fields& text) {
  if (text.takes('Z')) return 0;
  const bool is_behind = text.takes('-');
  if (!is_behind) text.skip('+');
  const int hours = text.number(2, 0, 14);
  text.skip(':');
  const int minutes = 60 * hours + text.number(2, 0, 59);
  return is_behind ? -minutes : minutes;
}

}  // namespace

SunPosition sun_position(double time_s, double latitude_deg, double longitude_deg) {
  constexpr double kJ2000_s = 946728000;  // 2000-01-01T12:00Z
  const double days = (time_s - kJ2000_s) / 86400;
  const double anomaly = glm::radians(357.528 + 0.9856003 * days);
  const double longitude =
      glm::radians(280.460 + 0.9856474 * days + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly));  // ecliptic
  const double obliquity = glm::radians(23.439 - 0.0000004 * days);
  const double ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double sidereal_deg = 280.46062 + 360.98564737 * days + longitude_deg;
  const double hour_angle = glm::radians(turned_deg(sidereal_deg)) - ascension, latitude = glm::radians(latitude_deg);
  const double up =
      std::sin(latitude) * std::sin(declination) + std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north =
      std::cos(latitude) * std::sin(declination) - std::sin(latitude) * std::cos(declination) * std::cos(hour_angle);
  return {glm::degrees(std::atan2(up, std::hypot(east, north))), turned_deg(glm::degrees(std::atan2(east, north)))};
}

std::optional<double> time_from_text(std::string_view text) {
  Fields fields{text};
  const int year = fields.number(4, 1, 9999);
  fields.skip('-');
  const int month = fields.number(2, 1, 12);
  fields.skip('-');
  const int day = fields.number(2, 1, 31);
  fields.skip('T');
  const int hour = fields.number(2, 0, 23);
  fields.skip(':');
  const int minute = fields.number(2, 0, 59);
  const int second = fields.takes(':') ? fields.number(2, 0, 59) : 0;
  const int ahead = ahead_min(fields);
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (fields.failed || !fields.left.empty() || !date.ok()) return std::nullopt;
  const auto days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  return 86400 * days + 3600.0 * hour + 60.0 * (minute - ahead) + second;
}

}  // namespace catchlight::render
