// Real spherical harmonics: evaluation, rotation and the closed forms of lighting.
//
// Convention (pinned by absolute values in tests/render/math/sh_test.cpp): real, orthonormal over the sphere, index l(l+1)+m,
// WITHOUT the Condon-Shortley phase: y(1,-1) ~ +y, y(1,0) ~ +z, y(1,1) ~ +x. n bands have n^2 coefficients (l = 0 .. n-1).
// Sources: Sloan, "Stupid Spherical Harmonics (SH) Tricks", 2008; Green, "Spherical Harmonic Lighting", 2003;
// Ramamoorthi & Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace catchlight::render {

inline constexpr int kMaxShBands = 10;

constexpr int sh_index(int l, int m) {
  return l * (l + 1) + m;
}
constexpr int sh_count(int bands) {
  return bands * bands;
}

/// y_i(direction) for all i < bands^2. `direction` has length 1; `out` holds bands^2 values. Computed in double.
void evaluate_sh(const glm::dvec3& direction, int bands, std::span<float> out);
void evaluate_sh(const glm::dvec3& direction, int bands, std::span<double> out);

/// Adds weight[k] * y_i(direction k) of all k to sums[i], for all i < bands^2: many directions at once, in single precision. x,
/// y, z and `weight` have a value a direction.
void add_sh(std::span<const float> x, std::span<const float> y, std::span<const float> z, std::span<const float> weight,
            int bands, std::span<float> sums);

/// RGB coefficients of a radiance function.
using ShRgb = std::vector<glm::vec3>;

/// Coefficients of f(inverse(rotation) * direction), exact for every band: rotate(project(f)) = project(rotate(f)).
ShRgb rotate_sh(const ShRgb& coefficients, const glm::dmat3& rotation);

/// Irradiance / pi (radiosity of a white Lambertian surface) at `normal`, unshadowed: per band A_l / pi, A_l from Ramamoorthi &
/// Hanrahan.
glm::dvec3 irradiance_over_pi(const ShRgb& radiance, const glm::dvec3& normal);

/// A_l / pi of the clamped cosine lobe: 1, 2/3, 1/4, 0, -1/24, 0, ... any l.
double cosine_lobe_over_pi(int l);

}  // namespace catchlight::render
