#include "render/cpu/surface/highlights.hpp"

#include <gtest/gtest.h>

#include <random>

#include "render/render_scene.hpp"
#include "shaders/shading.h"
#include "tests/support/random_direction.hpp"

namespace catchlight::render {
namespace {

std::mt19937 random_numbers(8);

std::vector<LightSample> random_samples(int count) {
  std::uniform_real_distribution<double> value(0, 1);
  std::vector<LightSample> samples;
  for (int i = 0; i < count; ++i)
    samples.push_back({random_direction<double>(random_numbers),
                       {value(random_numbers), value(random_numbers), value(random_numbers)},
                       0.2 * value(random_numbers),
                       i % 3 != 0});
  return samples;
}

TEST(Highlights, AreTheSumOfWhatEachLampDoes) {
  std::uniform_real_distribution<float> value(0, 1);
  for (const int count : {0, 1, 7, kMaxLightSamples}) {
    const std::vector<LightSample> samples = random_samples(count);
    Highlights highlights;
    highlights.set_samples(samples);
    for (int i = 0; i < 200; ++i) {
      GlossySurface surface{glm::vec3(random_direction<double>(random_numbers)),
                            glm::vec3(random_direction<double>(random_numbers)), 0.01f + value(random_numbers),
                            glm::vec3(value(random_numbers), value(random_numbers), value(random_numbers)),
                            value(random_numbers)};
      surface.alpha = std::min(surface.alpha, 1.0f);
      if (glm::dot(surface.normal, surface.to_viewer) < 0) surface.to_viewer = -surface.to_viewer;
      std::vector<float> shares;
      for (int k = 0; k < count; ++k) shares.push_back(k % 4 == 0 ? 0 : value(random_numbers));
      glm::dvec3 expected(0);
      for (std::size_t k = 0; k < samples.size(); ++k) {
        const float n_l = glm::dot(surface.normal, glm::vec3(samples[k].direction));
        if (!samples[k].compact || n_l <= 0) continue;
        const glm::vec3 brdf =
            shading::glossy_brdf(surface.normal, surface.to_viewer, glm::vec3(samples[k].direction),
                                 static_cast<float>(samples[k].spread_rad), surface.alpha, surface.f0, surface.f90);
        expected += samples[k].irradiance * double{shares[k]} * double{n_l} * glm::dvec3(brdf);
      }
      const glm::dvec3 found(highlights.radiance(surface, shares.data()));
      EXPECT_LT(glm::distance(found, expected), 1e-3 * glm::length(expected) + 1e-6)
          << count << " lamps, alpha " << surface.alpha;
    }
  }
}

TEST(Highlights, FollowTheLight) {
  Highlights highlights;
  const std::vector<float> shares(kMaxLightSamples, 1.0f);
  highlights.set_samples(random_samples(50));
  highlights.set_samples({});
  EXPECT_EQ(highlights.radiance({{0, 0, 1}, {0, 0, 1}, 0.3f, glm::vec3(1), 1}, shares.data()), glm::vec3(0));
}

TEST(Highlights, OfALampOnTheHorizonOrBehindTheSurfaceAreFinite) {
  const std::vector<float> shares(1, 1.0f);
  for (const glm::dvec3& direction : {glm::dvec3(1, 0, 0), {0, 0, -1}, {-1, 0, 1e-9}, {0, 1, -1e-9}}) {
    Highlights highlights;
    const std::vector<LightSample> one{{glm::normalize(direction), {5, 5, 5}}};
    highlights.set_samples(one);
    for (const glm::vec3& viewer : {glm::vec3(0, 0, 1), {1, 0, 0}, {-1, 0, 0}}) {
      const glm::vec3 light = highlights.radiance({{0, 0, 1}, viewer, 0.01f, glm::vec3(0.5f), 1}, shares.data());
      EXPECT_TRUE(std::isfinite(light.x) && light.x >= 0) << light.x;
    }
  }
}

}  // namespace
}  // namespace catchlight::render
