#include "render/math/hemisphere_rays.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace catchlight::render {
namespace {

std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

// Sobol's second dimension: direction numbers v, v ^ v/2, ...
std::uint32_t sobol_second(std::uint32_t k) {
  std::uint32_t value = 0;
  for (std::uint32_t v = 1u << 31; k != 0; k >>= 1, v ^= v >> 1) {
    if (k & 1) value ^= v;
  }
  return value;
}

}  // namespace

// Each bit is changed depending on lower bits only: on reversed numbers that is nested scrambling.
std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reversed(x);
}

std::uint32_t mix_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

std::uint32_t seed_of(const glm::vec3& position, const glm::vec3& normal, std::uint32_t seed) {
  std::uint32_t hash = mix_bits(seed);
  for (const glm::vec3& v : {position, normal}) {
    for (int c = 0; c < 3; ++c) hash = mix_bits(hash ^ std::bit_cast<std::uint32_t>(v[c] + 0.0f));
  }
  return hash;
}

glm::dvec2 scrambled_sobol(std::uint32_t k, std::uint32_t seed) {
  const std::uint32_t x = owen_scrambled(reversed(k), mix_bits(seed));
  const std::uint32_t y = owen_scrambled(sobol_second(k), mix_bits(seed ^ 0x7f4a7c15u));
  return {x * 0x1p-32, y * 0x1p-32};
}

// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017: no direction is a special case.
Hemisphere::Hemisphere(const glm::vec3& normal) : normal_(glm::normalize(glm::dvec3(normal))) {
  const double sign = std::copysign(1.0, normal_.z), a = -1.0 / (sign + normal_.z), b = normal_.x * normal_.y * a;
  tangent_ = {1 + sign * normal_.x * normal_.x * a, sign * b, -sign * normal_.x};
  bitangent_ = {b, sign + normal_.y * normal_.y * a, -normal_.y};
}

// Malley's method: a uniform point of the disc, lifted to the sphere.
glm::vec3 Hemisphere::direction(const glm::dvec2& square) const {
  const double radius = std::sqrt(square.x), phi = 2 * std::numbers::pi * square.y;
  return glm::vec3(tangent_ * (radius * std::cos(phi)) + bitangent_ * (radius * std::sin(phi)) +
                   normal_ * std::sqrt(std::max(0.0, 1 - square.x)));
}

glm::vec3 Hemisphere::cone_direction(const glm::dvec2& square, double cos_cone) const {
  const double height = 1 - square.x * (1 - cos_cone), radius = std::sqrt(std::max(0.0, 1 - height * height));
  const double phi = 2 * std::numbers::pi * square.y;
  return glm::vec3(tangent_ * (radius * std::cos(phi)) + bitangent_ * (radius * std::sin(phi)) + normal_ * height);
}

}  // namespace catchlight::render
