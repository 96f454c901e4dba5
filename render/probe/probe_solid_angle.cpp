// Exact solid angles of texels. Sum over the image: 4 pi in every layout.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/probe/probe_layouts.hpp"

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

// Texel centres lie on the poles and on +-180 degrees: pole rows are caps of half a row, the outer columns half as wide.
double latlong_solid_angle(int width, int height, int x, int y) {
  const double half_row = kPi / (height - 1) / 2, latitude = kPi / 2 - 2 * half_row * y;
  const double top = std::min(latitude + half_row, kPi / 2), bottom = std::max(latitude - half_row, -kPi / 2);
  const double column = 2 * kPi / (width - 1) * (x == 0 || x == width - 1 ? 0.5 : 1.0);
  return column * 2 * std::cos((top + bottom) / 2) * std::sin((top - bottom) / 2);  // = column (sin top - sin bottom)
}

// Solid angle of the rectangle from the face's middle to (s, t).
double face_corner(double s, double t) {
  return std::atan2(s * t, std::sqrt(s * s + t * t + 1));
}

double cube_solid_angle(ProbeLayout layout, int width, int x, int y) {
  const int size = face_size(layout, width);
  const auto bound = [&](double texel) { return std::clamp(face_from_texel(layout, size, texel), -1.0, 1.0); };
  const double left = bound(x % size - 0.5), right = bound(x % size + 0.5);
  const double top = bound(y % size - 0.5), bottom = bound(y % size + 0.5);
  return face_corner(right, bottom) - face_corner(left, bottom) - face_corner(right, top) + face_corner(left, top);
}

// Disc layouts. A direction at angle a from +z lies at radius r; the cap within r has 2 pi (1 - cos a) sr. By Green's theorem
// the solid angle of any region is the integral of (1 - cos a(r)) dtheta along its border, with the value 2 of the full sphere
// where the border runs outside the disc. Both integrands are smooth along a line, so few Gauss points reach double precision.
double cap_over_radius_squared(ProbeLayout layout, double radius_squared) {
  if (layout == ProbeLayout::mirror_ball) return 2.0;  // 1 - cos a = 2 sin^2(a/2) = 2 r^2
  const double half = kPi / 2 * std::sqrt(radius_squared);
  const double sinc = half > 1e-8 ? std::sin(half) / half : 1.0;
  return 2 * sinc * sinc * (kPi / 2) * (kPi / 2);
}

double turn(const glm::dvec2& from, const glm::dvec2& to) {
  return std::atan2(from.x * to.y - from.y * to.x, glm::dot(from, to));
}

double integral_inside(ProbeLayout layout, const glm::dvec2& from, const glm::dvec2& to) {
  constexpr std::array<double, 4> kNodes{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr std::array<double, 4> kWeights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  double mean = 0;
  for (int i = 0; i < 4; ++i) {
    for (const double node : {kNodes[i], -kNodes[i]}) {
      const glm::dvec2 point = glm::mix(from, to, (1 + node) / 2);
      mean += kWeights[i] / 2 * cap_over_radius_squared(layout, glm::dot(point, point));
    }
  }
  return mean * (from.x * to.y - from.y * to.x);  // r^2 dtheta = x dy - y dx, constant along a line
}

// Along the segment, split where it crosses the unit circle.
double border_integral(ProbeLayout layout, const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 along = to - from;
  const double a = glm::dot(along, along), b = glm::dot(from, along), c = glm::dot(from, from) - 1;
  const double root = std::sqrt(std::max(0.0, b * b - a * c));
  const glm::dvec2 enter = from + along * std::clamp((-b - root) / a, 0.0, 1.0);
  const glm::dvec2 leave = from + along * std::clamp((-b + root) / a, 0.0, 1.0);
  return 2 * turn(from, enter) + integral_inside(layout, enter, leave) + 2 * turn(leave, to);
}

double square_solid_angle(ProbeLayout layout, int width, int height, int x, int y) {
  const double left = 2.0 * x / width - 1, right = 2.0 * (x + 1) / width - 1;
  const double top = 2.0 * y / height - 1, bottom = 2.0 * (y + 1) / height - 1;
  const std::array<glm::dvec2, 5> corners{{{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}};
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += border_integral(layout, corners[i], corners[i + 1]);
  return sum;
}

// A texel whose centre misses the disc holds no light; what it covers of the disc counts for the texel that stands for it.
double disc_solid_angle(ProbeLayout layout, int width, int height, int x, int y) {
  if (nearest_disc_texel(width, height, x, y) != glm::ivec2(x, y)) return 0.0;
  double sum = 0;
  for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height - 1); ++ny) {
    for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx) {
      if (nearest_disc_texel(width, height, nx, ny) == glm::ivec2(x, y)) sum += square_solid_angle(layout, width, height, nx, ny);
    }
  }
  return sum;
}

}  // namespace

double texel_solid_angle(ProbeLayout layout, int width, int height, int x, int y) {
  if (layout == ProbeLayout::latlong) return latlong_solid_angle(width, height, x, y);
  if (!direction_from_texel(layout, width, height, x, y)) return 0.0;
  return is_disc(layout) ? disc_solid_angle(layout, width, height, x, y) : cube_solid_angle(layout, width, x, y);
}

}  // namespace catchlight::render
