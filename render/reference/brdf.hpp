// How a surface of the reference reflects light: glTF 2.0's metallic-roughness materials as the ground truth understands them.
//
// Dielectrics: Lambert (1 - F) + F GGX, F Schlick's Fresnel factor of n.v, so that no more leaves than arrives. Metals: GGX,
// single scattering, Schlick's factor of v.h with the base colour at normal incidence. Masking and shadowing are Smith's,
// separable: G1(v) G1(l) (Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 2014).
#pragma once

#include <glm/glm.hpp>

#include "render/mesh/mesh.hpp"

namespace catchlight::render::reference {

/// Directions are unit vectors in the surface's frame, z along its normal; v to the viewer, l to the light, both with z > 0.
class Brdf {
 public:
  /// `color` multiplies the base colour. Roughness below 0.01 is taken for 0.01, a lobe of a hundredth of a degree.
  Brdf(const Material& material, const glm::dvec3& color);

  /// Matte, and nothing else.
  static Brdf lambertian(const glm::dvec3& albedo);

  /// The Lambertian part's albedo as seen from v.
  glm::dvec3 diffuse_albedo(const glm::dvec3& v) const;

  /// The glossy part's value, 1/sr.
  glm::dvec3 glossy(const glm::dvec3& v, const glm::dvec3& l) const;

  /// A direction l for glossy(), by visible normals (Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018); may
  /// have z <= 0, which reflects nothing.
  glm::dvec3 sample_glossy(const glm::dvec3& v, const glm::dvec2& square) const;
  double glossy_density(const glm::dvec3& v, const glm::dvec3& l) const;

  /// Roughly the share of reflected light that is glossy, 0 to 1: how often to follow it.
  double glossy_share(const glm::dvec3& v) const;

 private:
  Brdf() = default;
  double distribution(const glm::dvec3& h) const;
  double masking(const glm::dvec3& w) const;
  double dielectric_fresnel(double n_v) const;

  glm::dvec3 base_{0};
  double metallic_ = 0, f0_ = 0, f90_ = 0, alpha_ = 1;
};

}  // namespace catchlight::render::reference
