// Lights of a split probe as samples: none carries much more of the light than others, however few texels hold it.
#include <gtest/gtest.h>

#include <algorithm>

#include "catchlight/color.hpp"
#include "catchlight/image.hpp"
#include "render/probe/probe_split.hpp"

namespace catchlight::render {
namespace {

double luminance_of(const LightSample& sample) {
  return glm::dot(kLuminanceWeights, sample.irradiance);
}

/// A sun of 2 x 2 texels with most of the light, in the middle of a bright patch of sky that is one light with it.
Probe sun_in_a_bright_sky() {
  Probe probe{Image(256, 128), ProbeLayout::latlong};
  std::fill(probe.image.data.begin(), probe.image.data.end(), 0.1f);
  for (int y = 32; y < 56; ++y)
    for (int x = 100; x < 124; ++x) std::fill_n(probe.image.pixel(x, y), 3, 20.0f);
  for (int y = 43; y < 45; ++y)
    for (int x = 111; x < 113; ++x) std::fill_n(probe.image.pixel(x, y), 3, 2e4f);
  return probe;
}

TEST(LightDivision, ASunOfFewTexelsInABrightSkyIsDividedToo) {
  const SplitProbe split = split_lights(sun_in_a_bright_sky(), {.bands = 10, .tolerance = 0.004, .max_samples = 64});
  ASSERT_EQ(split.lights.size(), 1u);
  const std::vector<LightSample>& samples = split.lights[0].samples;
  EXPECT_GE(samples.size(), 60u);
  double total = 0, brightest = 0;
  for (const LightSample& sample : samples) {
    total += luminance_of(sample);
    brightest = std::max(brightest, luminance_of(sample));
  }
  EXPECT_LT(brightest, 2 * total / static_cast<double>(samples.size()));
}

}  // namespace
}  // namespace catchlight::render
