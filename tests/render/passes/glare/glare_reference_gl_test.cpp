// Fast glare against a convolution of the same excess with the kernel that it states.
#include <algorithm>
#include <cmath>

#include "catchlight/image.hpp"
#include "render/glare/glare_kernel.hpp"
#include "render/math/fft_convolution.hpp"
#include "render/settings.hpp"
#include "tests/support/glare_fixture.hpp"
#include "tests/support/glare_scenes.hpp"

namespace catchlight::render::test {
namespace {

class GlareReferenceGl : public GlTest {};

struct Difference {
  double largest, mean;  ///< in shares of the reference's peak
};

Difference difference(const Image& fast, const Image& reference) {
  double peak = 0, largest = 0, sum = 0;
  for (std::size_t i = 0; i < fast.data.size(); ++i) {
    const double d = std::abs(fast.data[i] - reference.data[i]);
    peak = std::max<double>(peak, reference.data[i]);
    largest = std::max(largest, d);
    sum += d;
  }
  return {largest / peak, sum / static_cast<double>(fast.data.size()) / peak};
}

Difference against_reference(const GlareSettings& settings, const Image& picture) {
  const int width = picture.width, height = picture.height;
  const Glared fast = glared(settings, picture);
  const Image excess = at_frame_pixels(fast.excess, fast.grid, width, height);
  const FftConvolution convolution(glare_kernel(settings, height, 2 * width - 1, 2 * height - 1), width, height);
  return difference(at_frame_pixels(fast.glare, fast.grid, width, height), convolution.convolve(excess));
}

TEST_F(GlareReferenceGl, ThreeScenesAreWithinThreePercentOfTheirPeak) {
  for (const NamedScene& scene : glare_scenes()) {
    for (const int directions : {4, 6}) {
      GlareSettings settings;
      settings.streak_directions = directions;
      settings.streak_rotation_deg = directions == 4 ? 45 : 20;
      const Difference d = against_reference(settings, scene.make(640, 480));
      EXPECT_LT(d.largest, 0.03) << scene.name << ", " << directions << " directions";
      EXPECT_LT(d.mean, 0.003) << scene.name << ", " << directions << " directions";
    }
  }
}

TEST_F(GlareReferenceGl, NothingVisibleLiesBeyondTheReach) {
  for (const float radiance : {40.0f, 1000.0f}) {
    const GlareSettings settings;
    const Image picture = one_pixel_highlight(640, 480, 200, 150, radiance);
    const Glared fast = glared(settings, picture);
    const Image excess = at_frame_pixels(fast.excess, fast.grid, 640, 480);
    const Image all = FftConvolution(glare_kernel(settings, 480, 1279, 959), 640, 480).convolve(excess);
    EXPECT_LT(fast.reach.width * fast.reach.height, radiance < 100 ? 640 * 480 / 4 : 640 * 480);
    float largest = 0;
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        if (intersect(fast.reach, {x, y, 1, 1}).empty()) largest = std::max(largest, all.pixel(x, y)[0]);
      }
    }
    EXPECT_LT(largest, 7.6e-5f) << "a quarter of an 8-bit sRGB code in black";
  }
}

}  // namespace
}  // namespace catchlight::render::test
