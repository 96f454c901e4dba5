#include "render/math/hemisphere_rays.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace catchlight::render {
namespace {

constexpr int kRaysPerCell = 16;  // as many as Embree takes together, where it can

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

// Owen's scrambling of a number whose bits are reversed: each bit is changed depending on lower bits only.
std::uint32_t scrambled_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  return x ^ x * 0x53a22864u;
}

constexpr std::uint32_t kSecondSeed = 0x7f4a7c15u;  // sets the second dimension's seed apart from the first one's

// scrambled_sobol(k) for all k, in units of 2^-32.
[[gnu::target_clones("avx2", "default")]] void scramble(std::span<const std::uint32_t> second, std::uint32_t seed_x,
                                                        std::uint32_t seed_y, std::span<std::uint32_t> x,
                                                        std::span<std::uint32_t> y) {
  for (std::size_t k = 0; k < second.size(); ++k) {
    x[k] = reversed(scrambled_reversed(static_cast<std::uint32_t>(k), seed_x));
    y[k] = reversed(scrambled_reversed(second[k], seed_y));
  }
}

// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017: no direction is a special case. Columns: tangent,
// bitangent, normal.
glm::mat3 frame_around(const glm::vec3& direction) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(direction));
  const double sign = std::copysign(1.0, n.z), a = -1.0 / (sign + n.z), b = n.x * n.y * a;
  return {glm::dvec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), glm::dvec3(b, sign + n.y * n.y * a, -n.y), n};
}

struct SinCos {
  float sin, cos;
};

// Sine and cosine of an angle in turns, from 0 to 1: Taylor's series over an eighth of a turn, whose rest is below the rounding.
[[gnu::always_inline]] inline SinCos sin_cos_of_turn(float turn) {
  const int quarter = static_cast<int>(turn * 4 + 0.5f);
  const float angle = (turn - static_cast<float>(quarter) * 0.25f) * (2 * std::numbers::pi_v<float>), square = angle * angle;
  const float s = angle * (1 + square * (-1.0f / 6 + square * (1.0f / 120 + square * (-1.0f / 5040 + square / 362880))));
  const float c = 1 + square * (-0.5f + square * (1.0f / 24 + square * (-1.0f / 720 + square / 40320)));
  const float sign = quarter & 2 ? -1.0f : 1.0f, swapped = quarter & 1 ? c : s, other = quarter & 1 ? -s : c;
  return {sign * swapped, sign * other};
}

enum class Lift { hemisphere, cone };

// Takes points of the unit square, in units of 2^-32, to directions.
template <Lift kLift>
[[gnu::always_inline]] inline void lift_all(std::span<const std::uint32_t> x, std::span<const std::uint32_t> y,
                                            const glm::mat3& frame, float cap_height, const HemisphereRays::Directions& out) {
  const glm::vec3 tangent = frame[0], bitangent = frame[1], axis = frame[2];  // copies: nothing that is written to is among them
  float *const to_x = out.x.data(), *const to_y = out.y.data(), *const to_z = out.z.data();
  for (std::size_t k = 0; k < x.size(); ++k) {
    // 31 bits are enough for a float, and fit the signed integers that processors convert.
    const float across = static_cast<float>(static_cast<std::int32_t>(x[k] >> 1)) * 0x1p-31f;
    const SinCos turn = sin_cos_of_turn(static_cast<float>(static_cast<std::int32_t>(y[k] >> 1)) * 0x1p-31f);
    const float below = across * cap_height;  // the cone's cap
    const float height = kLift == Lift::cone ? 1 - below : std::sqrt(1 - across);
    const float radius = std::sqrt(kLift == Lift::cone ? below * (2 - below) : across);
    const float along = radius * turn.cos, beside = radius * turn.sin;
    to_x[k] = tangent.x * along + bitangent.x * beside + axis.x * height;
    to_y[k] = tangent.y * along + bitangent.y * beside + axis.y * height;
    to_z[k] = tangent.z * along + bitangent.z * beside + axis.z * height;
  }
}

// Malley's method: a uniform point of the disc, lifted to the sphere.
[[gnu::target_clones("avx2", "default")]] void lift_to_hemisphere(std::span<const std::uint32_t> x,
                                                                  std::span<const std::uint32_t> y, const glm::mat3& frame,
                                                                  const HemisphereRays::Directions& out) {
  lift_all<Lift::hemisphere>(x, y, frame, 0, out);
}

[[gnu::target_clones("avx2", "default")]] void lift_to_cone(std::span<const std::uint32_t> x, std::span<const std::uint32_t> y,
                                                            const glm::mat3& frame, float cap_height,
                                                            const HemisphereRays::Directions& out) {
  lift_all<Lift::cone>(x, y, frame, cap_height, out);
}

}  // namespace

std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
  return reversed(scrambled_reversed(reversed(x), seed));
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
  const std::uint32_t y = owen_scrambled(sobol_second(k), mix_bits(seed ^ kSecondSeed));
  return {x * 0x1p-32, y * 0x1p-32};
}

HemisphereRays::HemisphereRays(int count)
    : second_(count), x_(count), y_(count), sorted_x_(count), sorted_y_(count), sorted_k_(count) {
  const int bits = std::bit_width(static_cast<unsigned>(count / kRaysPerCell + 1)) - 1;
  cell_bits_y_ = std::min((bits + 2) / 2, bits);  // the azimuth goes once round
  cell_bits_x_ = bits - cell_bits_y_;
  cell_begin_.resize((std::size_t{1} << bits) + 1);
  for (int k = 0; k < count; ++k) second_[k] = reversed(sobol_second(k));
}

// Sets sorted_x_ and sorted_y_, in units of 2^-32, and sorted_k_, cell by cell.
void HemisphereRays::scatter(std::uint32_t seed) {
  scramble(second_, mix_bits(seed), mix_bits(seed ^ kSecondSeed), x_, y_);
  const auto cell = [this](std::size_t k) {
    return static_cast<std::size_t>(x_[k]) >> (32 - cell_bits_x_) << cell_bits_y_ |
           static_cast<std::size_t>(y_[k]) >> (32 - cell_bits_y_);
  };
  std::ranges::fill(cell_begin_, 0);
  for (std::size_t k = 0; k < x_.size(); ++k) ++cell_begin_[cell(k) + 1];
  for (std::size_t i = 1; i < cell_begin_.size(); ++i) cell_begin_[i] += cell_begin_[i - 1];
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const std::uint32_t at = cell_begin_[cell(k)]++;
    sorted_x_[at] = x_[k], sorted_y_[at] = y_[k], sorted_k_[at] = static_cast<std::uint32_t>(k);
  }
}

void HemisphereRays::fill_hemisphere(const glm::vec3& normal, std::uint32_t seed, const Directions& out) {
  scatter(seed);
  lift_to_hemisphere(sorted_x_, sorted_y_, frame_around(normal), out);
}

void HemisphereRays::fill_cone(const glm::vec3& axis, double cos_cone, std::uint32_t seed, const Directions& out) {
  scatter(seed);
  lift_to_cone(sorted_x_, sorted_y_, frame_around(axis), static_cast<float>(1 - cos_cone), out);
}

}  // namespace catchlight::render
