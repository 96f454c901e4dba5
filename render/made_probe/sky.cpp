#include "render/made_probe/sky.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace catchlight::render {
namespace {

using Five = std::array<double, 5>;
using Polynomial = std::array<double, 4>;  ///< of the sun's angle from the zenith, highest power first

/// How the five coefficients of luminance, x and y rise with turbidity, and what they are without any (the paper's A.2).
constexpr std::array<Five, 3> kSlope{{{0.1787, -0.3554, -0.0227, 0.1206, -0.0670},
                                      {-0.0193, -0.0665, -0.0004, -0.0641, -0.0033},
                                      {-0.0167, -0.0950, -0.0079, -0.0441, -0.0109}}};
constexpr std::array<Five, 3> kOffset{{{-1.4630, 0.4275, 5.3251, -2.5771, 0.3703},
                                       {-0.2592, 0.0008, 0.2125, -0.8989, 0.0452},
                                       {-0.2608, 0.0092, 0.2102, -1.6537, 0.0529}}};

/// The zenith's x and y: times turbidity squared, turbidity, 1.
constexpr std::array<Polynomial, 3> kZenithX{
    {{0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr std::array<Polynomial, 3> kZenithY{
    {{0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}}};

double value_of(const Polynomial& p, double x) {
  return ((p[0] * x + p[1]) * x + p[2]) * x + p[3];
}

double chromaticity(const std::array<Polynomial, 3>& of, double turbidity, double sun_from_zenith_rad) {
  const auto at = [&](int i) { return value_of(of[i], sun_from_zenith_rad); };
  return (at(0) * turbidity + at(1)) * turbidity + at(2);
}

/// Perez's function, without the 1 / 0 that its exponent has at the horizon.
double perez(const Five& p, double from_zenith_rad, double from_sun_rad) {
  const double cos_zenith = std::max(std::cos(from_zenith_rad), 1e-4), cos_sun = std::cos(from_sun_rad);
  return (1 + p[0] * std::exp(p[1] / cos_zenith)) * (1 + p[2] * std::exp(p[3] * from_sun_rad) + p[4] * cos_sun * cos_sun);
}

/// From 380 to 750 nm in steps of 10: the sun's radiance above the air in W / (cm^2 um sr), over 10, and how much ozone takes,
/// per cm (the paper's table 2).
constexpr int kFirst_nm = 380, kStep_nm = 10;
constexpr std::array kSun{165.5, 162.3, 211.2, 258.8, 258.2, 242.3, 267.6, 296.6, 305.4, 300.6, 306.6, 288.3, 287.1,
                          278.2, 271.0, 272.3, 263.6, 255.0, 250.6, 253.1, 253.5, 251.3, 246.3, 241.7, 236.8, 232.1,
                          228.2, 223.4, 219.7, 215.3, 211.0, 207.3, 202.4, 198.7, 194.3, 190.7, 186.3, 182.6};
constexpr std::array kOzone{0.0,   0.0,   0.0,   0.0,   0.0,   0.0,   0.0,   0.003, 0.006, 0.009, 0.014, 0.021, 0.030,
                            0.040, 0.048, 0.063, 0.075, 0.085, 0.103, 0.120, 0.120, 0.115, 0.125, 0.120, 0.105, 0.090,
                            0.079, 0.067, 0.057, 0.048, 0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009};
constexpr double kOzone_cm = 0.35;

/// A bell with another width on each side.
double bell(double wavelength_nm, double middle, double width_below, double width_above) {
  const double t = (wavelength_nm - middle) / (wavelength_nm < middle ? width_below : width_above);
  return std::exp(-t * t / 2);
}

/// The CIE's colour matching functions of 1931, as C. Wyman, P.-P. Sloan and P. Shirley fit them (JCGT 2013).
glm::dvec3 color_matching(double nm) {
  return {1.056 * bell(nm, 599.8, 37.9, 31.0) + 0.362 * bell(nm, 442.0, 16.0, 26.7) - 0.065 * bell(nm, 501.1, 20.4, 26.2),
          0.821 * bell(nm, 568.8, 46.9, 40.5) + 0.286 * bell(nm, 530.9, 16.3, 31.1),
          1.217 * bell(nm, 437.0, 11.8, 36.0) + 0.681 * bell(nm, 459.0, 26.0, 13.8)};
}

/// How many times the air of the zenith the sun shines through.
double air_mass(double sun_from_zenith_rad) {
  return 1 / (std::cos(sun_from_zenith_rad) + 0.15 * std::pow(93.885 - glm::degrees(sun_from_zenith_rad), -1.253));
}

}  // namespace

glm::dvec3 rec709_from(const LuminanceXy& light) {
  const double sum = light.luminance / light.y;
  const glm::dvec3 xyz(light.x * sum, light.luminance, (1 - light.x - light.y) * sum);
  const glm::dmat3 rec709_from_xyz(3.2406, -0.9689, 0.0557, -1.5372, 1.8758, -0.2040, -0.4986, 0.0415, 1.0570);
  return glm::max(rec709_from_xyz * xyz, glm::dvec3(0));
}

ClearSky::ClearSky(double turbidity, double sun_elevation_rad) {
  const double sun_rad = glm::half_pi<double>() - sun_elevation_rad;
  const double chi = (4.0 / 9 - turbidity / 120) * (glm::pi<double>() - 2 * sun_rad);
  const std::array zenith{(4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192,
                          chromaticity(kZenithX, turbidity, sun_rad), chromaticity(kZenithY, turbidity, sun_rad)};
  for (std::size_t i = 0; i < perez_.size(); ++i) {
    for (std::size_t k = 0; k < perez_[i].size(); ++k) perez_[i][k] = kSlope[i][k] * turbidity + kOffset[i][k];
    scale_[i] = zenith[i] / perez(perez_[i], 0, sun_rad);
  }
}

LuminanceXy ClearSky::at(double from_zenith_rad, double from_sun_rad) const {
  const auto value = [&](int i) { return scale_[i] * perez(perez_[i], from_zenith_rad, from_sun_rad); };
  return {value(0), value(1), value(2)};
}

LuminanceXy sun_disc(double turbidity, double sun_elevation_rad) {
  constexpr double kLumensPerWatt = 683;
  constexpr double kWattsPerMetreAndNanometre = 100;  // what the table's unit is
  const double mass = air_mass(glm::half_pi<double>() - sun_elevation_rad);
  const double haze = 0.04608 * turbidity - 0.04586;
  glm::dvec3 xyz(0);
  for (std::size_t i = 0; i < kSun.size(); ++i) {
    const double nm = kFirst_nm + kStep_nm * static_cast<double>(i), um = nm / 1000;
    // What gases and water vapour take lies beyond what the eye sees.
    const double taken = 0.008735 * std::pow(um, -4.08) + haze * std::pow(um, -1.3) + kOzone[i] * kOzone_cm;
    xyz += color_matching(nm) * (kSun[i] * kWattsPerMetreAndNanometre * std::exp(-mass * taken) * kStep_nm);
  }
  const double sum = xyz.x + xyz.y + xyz.z;
  return {kLumensPerWatt * xyz.y / 1000, xyz.x / sum, xyz.y / sum};
}

}  // namespace catchlight::render
