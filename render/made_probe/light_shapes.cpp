#include "render/made_probe/light_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace catchlight::render {
namespace {

/// A rectangle of light that faces the middle, at distance 1.
struct Softbox {
  double longitude_deg, latitude_deg;
  double half_width, half_height;
  double radiance;
};
constexpr double kEdge = 0.08;  ///< softboxes fade out over this much beside them
constexpr double kRoom = 0.03;  ///< the radiance of the room around them

/// As photographers set them for a product: the camera is at probe +z, the near side of a table.
constexpr std::array<Softbox, 3> kSoftboxes{{
    {-48, 46, 0.42, 0.42, 10},   // key
    {62, 24, 0.55, 0.45, 0.9},   // fill
    {160, 38, 0.14, 0.45, 8.0},  // rim
}};

/// The direction at these angles; longitude 0 is +z, 90 is +x.
glm::dvec3 direction_at(double longitude_deg, double latitude_deg) {
  const double longitude = glm::radians(longitude_deg), latitude = glm::radians(latitude_deg);
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude), std::cos(latitude) * std::cos(longitude)};
}

double share_in(double from_middle, double half) {
  return 1 - glm::smoothstep(half, half + kEdge, std::abs(from_middle));
}

double radiance_of(const Softbox& box, const glm::dvec3& direction) {
  const glm::dvec3 middle = direction_at(box.longitude_deg, box.latitude_deg);
  const double ahead = glm::dot(direction, middle);
  if (ahead <= 0) return 0;
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), middle)), up = glm::cross(middle, right);
  return box.radiance * share_in(glm::dot(direction, right) / ahead, box.half_width) *
         share_in(glm::dot(direction, up) / ahead, box.half_height);
}

/// The share of texel (x, y) from which less than `radius_rad` separates `towards`.
double share_of_texel(const Probe& probe, int x, int y, const glm::dvec3& towards, double radius_rad) {
  constexpr int kAcross = 16;
  int inside = 0;
  for (int i = 0; i < kAcross * kAcross; ++i) {
    const double sub_x = x + (i % kAcross + 0.5) / kAcross - 0.5, sub_y = y + (i / kAcross + 0.5) / kAcross - 0.5;
    const auto direction = direction_from_texel(probe.layout, probe.image.width, probe.image.height, sub_x, sub_y);
    inside += direction && glm::distance(*direction, towards) < radius_rad;
  }
  return inside / static_cast<double>(kAcross * kAcross);
}

}  // namespace

double overcast_radiance(const glm::dvec3& direction) {
  return (1 + 2 * direction.y) / 3;
}

double studio_radiance(const glm::dvec3& direction) {
  double radiance = kRoom;
  for (const Softbox& box : kSoftboxes) radiance += radiance_of(box, direction);
  return radiance;
}

void add_disc(Probe& probe, const glm::dvec3& towards, double diameter_deg, const glm::dvec3& irradiance) {
  const int width = probe.image.width, height = probe.image.height;
  const double radius_rad = glm::radians(diameter_deg / 2), texel_rad = glm::two_pi<double>() / width;
  Probe disc{Image(width, height, 1), probe.layout};
  double power = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 middle = direction_from_texel(probe.layout, width, height, x, y).value();
      if (glm::distance(middle, towards) > radius_rad + texel_rad) continue;
      const double share = share_of_texel(probe, x, y, towards, radius_rad);
      *disc.image.pixel(x, y) = static_cast<float>(share);
      power += share * texel_solid_angle(probe.layout, width, height, x, y) * glm::dot(middle, towards);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        probe.image.pixel(x, y)[c] += static_cast<float>(*disc.image.pixel(x, y) * irradiance[c] / power);
}

}  // namespace catchlight::render
