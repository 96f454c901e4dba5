#include "render/reference/brdf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "catchlight/color.hpp"

namespace catchlight::render::reference {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMinAlpha = 1e-4;

double fifth_power(double x) {
  return x * x * x * x * x;
}

}  // namespace

Brdf::Brdf(const Material& material, const glm::dvec3& color)
    : base_(glm::dvec3(material.base_color) * color),
      metallic_(std::clamp<double>(material.metallic, 0, 1)),
      f0_(material.dielectric_f0),
      // What reflects next to nothing head-on has no Fresnel rim either (Lagarde & de Rousiers 2014): 0 stands for "no gloss".
      f90_(std::clamp(50 * f0_, 0.0, 1.0)),
      alpha_(std::max<double>(material.roughness * material.roughness, kMinAlpha)) {}

Brdf Brdf::lambertian(const glm::dvec3& albedo) {
  Brdf brdf;
  brdf.base_ = albedo;
  return brdf;
}

double Brdf::dielectric_fresnel(double n_v) const {
  return f0_ + (f90_ - f0_) * fifth_power(1 - std::clamp(n_v, 0.0, 1.0));
}

glm::dvec3 Brdf::diffuse_albedo(const glm::dvec3& v) const {
  return base_ * ((1 - metallic_) * (1 - dielectric_fresnel(v.z)));
}

// GGX: alpha^2 / (pi (1 + hz^2 (alpha^2 - 1))^2) without the difference of nearly equal numbers.
double Brdf::distribution(const glm::dvec3& h) const {
  const double alpha2 = alpha_ * alpha_, root = (h.x * h.x + h.y * h.y) / alpha2 + h.z * h.z;
  return 1 / (kPi * alpha2 * root * root);
}

// G1(w) = 1 / (1 + Lambda(w)).
double Brdf::masking(const glm::dvec3& w) const {
  const double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
  return 2 / (1 + std::sqrt(1 + alpha_ * alpha_ * tan2));
}

glm::dvec3 Brdf::glossy(const glm::dvec3& v, const glm::dvec3& l) const {
  if (v.z <= 0 || l.z <= 0) return glm::dvec3(0);
  const glm::dvec3 h = glm::normalize(v + l);
  const glm::dvec3 metal = base_ + (1.0 - base_) * fifth_power(1 - std::clamp(glm::dot(v, h), 0.0, 1.0));
  const glm::dvec3 fresnel = glm::mix(glm::dvec3(dielectric_fresnel(v.z)), metal, metallic_);
  return fresnel * (distribution(h) * masking(v) * masking(l) / (4 * v.z * l.z));
}

glm::dvec3 Brdf::sample_glossy(const glm::dvec3& v, const glm::dvec2& square) const {
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha_ * v.x, alpha_ * v.y, v.z));
  const double across = std::hypot(stretched.x, stretched.y);
  const glm::dvec3 t1 = across > 0 ? glm::dvec3(-stretched.y, stretched.x, 0) / across : glm::dvec3(1, 0, 0);
  const glm::dvec3 t2 = glm::cross(stretched, t1);
  const double r = std::sqrt(square.x), phi = 2 * kPi * square.y, s = 0.5 * (1 + stretched.z);
  const double p1 = r * std::cos(phi), p2 = glm::mix(std::sqrt(1 - p1 * p1), r * std::sin(phi), s);
  const glm::dvec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * stretched;
  const glm::dvec3 h = glm::normalize(glm::dvec3(alpha_ * n.x, alpha_ * n.y, std::max(1e-12, n.z)));
  return glm::reflect(-v, h);
}

// Density of visible normals G1(v) D(h) (v.h) / vz, by the 4 (v.h) of reflection.
double Brdf::glossy_density(const glm::dvec3& v, const glm::dvec3& l) const {
  if (v.z <= 0 || l.z <= 0) return 0;
  return masking(v) * distribution(glm::normalize(v + l)) / (4 * v.z);
}

double Brdf::glossy_share(const glm::dvec3& v) const {
  const glm::dvec3 mirrored = glm::mix(glm::dvec3(dielectric_fresnel(v.z)), base_, metallic_);
  const double glossy = glm::dot(kLuminanceWeights, mirrored), matte = glm::dot(kLuminanceWeights, diffuse_albedo(v));
  return glossy > 0 ? glossy / (glossy + matte) : 0.0;
}

}  // namespace catchlight::render::reference
