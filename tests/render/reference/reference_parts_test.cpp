// What the reference path tracer is made of: its probe sampler, its surfaces, its camera.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/reference/brdf.hpp"
#include "render/reference/camera_rays.hpp"
#include "render/reference/point_stream.hpp"
#include "render/reference/probe_sampler.hpp"

namespace catchlight::render::reference {
namespace {

constexpr double kPi = std::numbers::pi;

/// Smooth in longitude and latitude, different in every channel, with a sun.
Probe varied_probe(int height) {
  Probe probe{Image(2 * height, height), ProbeLayout::latlong};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 2 * height; ++x) {
      const glm::dvec3 d = *direction_from_texel(ProbeLayout::latlong, 2 * height, height, x, y);
      const glm::dvec3 light(1 + d.x, 1.5 + d.y * d.z, 0.2 + d.y * d.y);
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = static_cast<float>(light[c]);
    }
  }
  std::fill_n(probe.image.pixel(height / 2, height / 4), 3, 5000.0f);
  return probe;
}

glm::dvec3 uniform_direction(const glm::dvec2& square) {
  const double z = 1 - 2 * square.x, r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(2 * kPi * square.y), r * std::sin(2 * kPi * square.y), z};
}

TEST(ReferenceProbe, IsTheSameFunctionAsTheProductsLookup) {
  const Probe probe = varied_probe(32);
  const glm::dmat3 tag_from_probe = render::tag_from_probe(UpAxis::z, 30);
  const ProbeSampler sampler(probe, tag_from_probe, false);
  for (int k = 0; k < 500; ++k) {
    const glm::dvec3 direction = uniform_direction(scrambled_sobol(k, 3));
    const glm::dvec3 here = sampler.radiance(direction), there(sample(probe, glm::transpose(tag_from_probe) * direction));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(here[c], there[c], 1e-4 * there[c]);
  }
}

TEST(ReferenceProbe, DensityIntegratesToOne) {
  // Uniform directions see it everywhere but at the sun, which stands apart: without it.
  Probe probe = varied_probe(32);
  std::fill_n(probe.image.pixel(16, 8), 3, 1.0f);
  for (const bool only_above : {false, true}) {
    const ProbeSampler sampler(probe, tag_from_probe(UpAxis::z, 0), only_above);
    double sum = 0;
    constexpr int kCount = 1 << 16;
    for (int k = 0; k < kCount; ++k) sum += sampler.density(uniform_direction(scrambled_sobol(k, 1))) * 4 * kPi / kCount;
    EXPECT_NEAR(sum, 1.0, 0.003) << only_above;
  }
}

TEST(ReferenceProbe, SamplesHaveTheDensityAndRadianceOfTheirDirection) {
  const ProbeSampler sampler(varied_probe(32), tag_from_probe(UpAxis::z, 77), true);
  for (int k = 0; k < 2000; ++k) {
    const auto light = sampler.sample(scrambled_sobol(k, 5));
    ASSERT_TRUE(light);
    EXPECT_NEAR(glm::length(light->direction_tag), 1, 1e-12);
    EXPECT_NEAR(sampler.density(light->direction_tag) / light->density, 1, 1e-5);
    EXPECT_NEAR(sampler.radiance(light->direction_tag).g / light->radiance.g, 1, 1e-5);
    EXPECT_GT(light->direction_tag.z, -0.11) << "at most a cell below the horizon";
  }
}

TEST(ReferenceProbe, SampledIrradianceIsTheExactOne) {
  const Probe probe = varied_probe(64);
  const ProbeSampler sampler(probe, tag_from_probe(UpAxis::z, 0), false);
  for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::dvec3(0.6, 0, 0.8), glm::dvec3(0, -0.8, 0.6)}) {
    glm::dvec3 sum(0);
    constexpr int kCount = 1 << 14;
    for (int k = 0; k < kCount; ++k) {
      const auto light = sampler.sample(scrambled_sobol(k, 9));
      sum += light->radiance * std::max(0.0, glm::dot(light->direction_tag, normal)) / (light->density * kCount);
    }
    const glm::dvec3 by_cells = sampler.irradiance(normal);
    const glm::dvec3 by_texels = irradiance(probe, glm::transpose(tag_from_probe(UpAxis::z, 0)) * normal);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(sum[c] / by_cells[c], 1, 0.002);
      EXPECT_NEAR(by_cells[c] / by_texels[c], 1, 0.003) << "another sum over the same texels";
    }
  }
}

TEST(ReferenceProbe, ASunTakesItsShareOfTheSamples) {
  Probe probe = varied_probe(64);
  std::fill_n(probe.image.pixel(40, 10), 3, 1e6f);
  const ProbeSampler sampler(probe, glm::dmat3(1), false);
  const glm::dvec3 sun = *direction_from_texel(ProbeLayout::latlong, 128, 64, 40, 10);
  int near_sun = 0;
  for (int k = 0; k < 1024; ++k) near_sun += glm::dot(sampler.sample(scrambled_sobol(k, 2))->direction_tag, sun) > std::cos(0.08);
  EXPECT_GT(near_sun, 1000);
}

TEST(ReferenceProbe, BlackHasNoSamples) {
  const ProbeSampler sampler({Image(32, 16), ProbeLayout::latlong}, glm::dmat3(1), false);
  EXPECT_FALSE(sampler.sample({0.5, 0.5}));
  EXPECT_EQ(sampler.density({0, 0, 1}), 0);
}

TEST(ReferenceProbe, EveryCornerOfTheSquareIsADirectionOrNone) {
  const ProbeSampler sampler(varied_probe(16), glm::dmat3(1), true);
  for (const double u : {0.0, 0.5, std::nextafter(1.0, 0.0)}) {
    for (const double v : {0.0, 0.5, std::nextafter(1.0, 0.0)}) {
      if (const auto light = sampler.sample({u, v})) {
        EXPECT_TRUE(std::isfinite(light->density));
        EXPECT_NEAR(glm::length(light->direction_tag), 1, 1e-12);
      }
    }
  }
}

// --- surfaces ---------------------------------------------------------------------------------------------------------------

Material material(float metallic, float roughness) {
  Material result;
  result.base_color = {1, 0.6f, 0.3f};
  result.metallic = metallic;
  result.roughness = roughness;
  return result;
}

glm::dvec3 at_angle(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(ReferenceBrdf, MetalsAreReciprocal) {
  const Brdf brdf(material(1, 0.4f), glm::dvec3(1));
  const glm::dvec3 v = at_angle(0.3, 0.1), l = at_angle(1.2, 2.5);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(brdf.glossy(v, l)[c], brdf.glossy(l, v)[c], 1e-12);
}

TEST(ReferenceBrdf, SampledAlbedoIsThatOfUniformDirections) {
  for (const float metallic : {0.0f, 0.5f, 1.0f}) {
    const Brdf brdf(material(metallic, 0.5f), glm::dvec3(1));
    for (const double theta : {0.0, 0.8, 1.4}) {
      const glm::dvec3 v = at_angle(theta, 0.4);
      constexpr int kCount = 1 << 16;
      double by_lobe = 0, by_sphere = 0, density = 0;
      for (int k = 0; k < kCount; ++k) {
        const glm::dvec3 l = brdf.sample_glossy(v, scrambled_sobol(k, 1)), u = uniform_direction(scrambled_sobol(k, 2));
        if (l.z > 0) by_lobe += brdf.glossy(v, l).g * l.z / brdf.glossy_density(v, l) / kCount;
        by_sphere += brdf.glossy(v, u).g * std::max(u.z, 0.0) * 4 * kPi / kCount;
        density += brdf.glossy_density(v, u) * 4 * kPi / kCount;
      }
      EXPECT_NEAR(by_lobe / by_sphere, 1, 0.01) << metallic << " " << theta;
      EXPECT_LT(density, 1.005) << "what is missing from 1 went below the surface";
      EXPECT_LT(by_lobe + brdf.diffuse_albedo(v).g, 1.0001);
    }
  }
}

TEST(ReferenceBrdf, MirrorReflectsIntoTheMirrorDirection) {
  const Brdf brdf(material(1, 0), glm::dvec3(1));
  const glm::dvec3 v = at_angle(1.0, 0.2);
  for (int k = 0; k < 100; ++k) {
    const glm::dvec3 l = brdf.sample_glossy(v, scrambled_sobol(k, 1));
    EXPECT_LT(glm::distance(l, glm::dvec3(-v.x, -v.y, v.z)), 0.02);
    EXPECT_TRUE(std::isfinite(brdf.glossy(v, l).g));
    EXPECT_NEAR(brdf.glossy(v, l).r * l.z / brdf.glossy_density(v, l), 1.0, 1e-6) << "base colour 1: all of it";
  }
}

TEST(ReferenceBrdf, WithoutSpecularThereIsLambertAlone) {
  Material matte = material(0, 1);
  matte.dielectric_f0 = 0;
  const Brdf brdf(matte, glm::dvec3(0.5));
  const glm::dvec3 grazing = at_angle(1.57, 0);
  EXPECT_EQ(brdf.glossy(grazing, at_angle(1.5, 3)), glm::dvec3(0));
  EXPECT_NEAR(brdf.diffuse_albedo(grazing).r, 0.5, 1e-12);
  EXPECT_EQ(brdf.glossy_share(grazing), 0);
}

// --- camera and numbers -----------------------------------------------------------------------------------------------------

TEST(ReferenceCamera, RaysAndPixelsAreInverse) {
  CameraModel camera{640, 480, 600, 610, 320, 238, {-0.3, 0.1, 0.001, -0.002, 0.02, 0, 0, 0}};
  RigidTransform camera_from_tag;
  camera_from_tag.rotation = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
  camera_from_tag.translation_m = {0.1, 0.2, 3};
  const CameraRays rays(camera, camera_from_tag);
  for (const glm::dvec2& pixel : {glm::dvec2(0, 0), glm::dvec2(639, 479), glm::dvec2(320, 100), glm::dvec2(7.25, 300.5)}) {
    const auto back = rays.pixel_of(rays.origin_tag_m() + 2.5 * rays.direction_tag(pixel));
    ASSERT_TRUE(back);
    EXPECT_LT(glm::distance(*back, pixel), 1e-6);
  }
  EXPECT_FALSE(rays.pixel_of(rays.origin_tag_m() - rays.direction_tag({320, 240}))) << "behind the camera";
}

TEST(ReferencePoints, PairsOfOnePathAreIndependent) {
  // Sums of two coordinates of different pairs: with dependent pairs their variance would not be 1/6.
  double sum = 0, squares = 0;
  constexpr int kCount = 1 << 12;
  for (int k = 0; k < kCount; ++k) {
    PointStream points(7, k);
    const double x = points.next().x + points.next().x;
    sum += x / kCount;
    squares += x * x / kCount;
  }
  EXPECT_NEAR(sum, 1.0, 1e-3);
  EXPECT_NEAR(squares - sum * sum, 1.0 / 6, 0.01);
}

}  // namespace
}  // namespace catchlight::render::reference
