// The light of a clear sky and of its sun, after A. J. Preetham, P. Shirley and B. Smits, "A Practical Analytic Model for
// Daylight", SIGGRAPH 1999. Turbidity says how much haze there is: 2 is very clear, 10 hazy.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace catchlight::render {

inline constexpr double kMinTurbidity = 2, kMaxTurbidity = 10;
inline constexpr double kSunDiameter_deg = 0.53;

/// Luminance in kcd/m^2 with chromaticities, as the CIE defines them.
struct LuminanceXy {
  double luminance, x, y;
};

/// Linear Rec. 709 of the same luminance; colours beyond it become the nearest that there are.
glm::dvec3 rec709_from(const LuminanceXy& light);

/// The sky without its sun.
class ClearSky {
 public:
  ClearSky(double turbidity, double sun_elevation_rad);

  /// In a direction above the horizon, by its angles from the zenith and from the sun.
  LuminanceXy at(double from_zenith_rad, double from_sun_rad) const;

 private:
  std::array<std::array<double, 5>, 3> perez_;  ///< of luminance, x and y: the paper's A to E
  std::array<double, 3> scale_;                 ///< what they are multiplied by, so that they agree in the zenith
};

/// The mean over the sun's disc, seen through the same air.
LuminanceXy sun_disc(double turbidity, double sun_elevation_rad);

}  // namespace catchlight::render
