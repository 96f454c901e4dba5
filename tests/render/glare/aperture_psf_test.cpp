// Diffraction against the closed forms of optics, and what must hold of any aperture's.
#include "render/glare/aperture_psf.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/glare/aperture_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace catchlight::render {
namespace {

Image rectangle(int size, int x, int y, int width, int height) {
  Image image(size, size, 1);
  for (int v = y; v < y + height; ++v)
    for (int u = x; u < x + width; ++u) *image.pixel(u, v) = 1;
  return image;
}

/// Share of the light in the quarter plane's box, both halves of the far field counted.
double both_halves(const ApertureFarField& field, double x0, double x1, double y0, double y1) {
  return field.share(x0, x1, y0, y1) + field.share(x0, x1, -y1, -y0);
}

double sum(const Image& image, int channel = 0) {
  double total = 0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < image.data.size(); i += static_cast<std::size_t>(image.channels))
    total += image.data[i];
  return total;
}

/// Energy by direction between two radii, `bins` of the whole turn.
std::vector<double> by_direction(const Image& psf, double near_px, double far_px, int bins) {
  std::vector<double> energy(static_cast<std::size_t>(bins), 0.0);
  const int middle = psf.width / 2;
  for (int y = 0; y < psf.height; ++y)
    for (int x = 0; x < psf.width; ++x) {
      const double radius = std::hypot(x - middle, y - middle);
      if (radius < near_px || radius > far_px) continue;
      const double turn = std::atan2(y - middle, x - middle) / glm::two_pi<double>();
      energy[static_cast<std::size_t>((turn + 1) * bins + 0.5) % energy.size()] += psf.pixel(x, y)[0];
    }
  return energy;
}

/// Directions in which there is a needle, in bins.
std::vector<int> needles(const std::vector<double>& energy) {
  double mean = 0;
  for (const double e : energy) mean += e / static_cast<double>(energy.size());
  std::vector<int> result;
  const auto at = [&](std::size_t i) { return energy[i % energy.size()]; };
  for (std::size_t i = energy.size(); i < 2 * energy.size(); ++i)
    if (at(i) > 2 * mean && at(i) >= at(i - 1) && at(i) > at(i + 1) && at(i) >= at(i - 2) && at(i) > at(i + 2))
      result.push_back(static_cast<int>(i - energy.size()));
  return result;
}

constexpr ApertureOptics kOptics{.aperture_mm = 0.5, .focal_px = 1000};

TEST(ApertureFarField, ACircleMakesAirysDisc) {
  const ApertureFarField field(circle_aperture(512), 8192);
  const double cycles = 1 / 0.98;  // over the circle's diameter, by cycles over the picture's width
  double inside = 0, share_at[40] = {};
  constexpr double kStep = 0.05;
  for (double x = 0; x < 4; x += kStep)
    for (double y = 0; y < 4; y += kStep) {
      const double share = 2 * both_halves(field, x, x + kStep, y, y + kStep);
      if (std::hypot(x + kStep / 2, y + kStep / 2) < 1.2197 * cycles) inside += share;
    }
  EXPECT_NEAR(inside, 0.8378, 0.002) << "encircled energy of the first zero (Born & Wolf, 8.5.2)";
  // Intensity (pi / 4) (2 J1(v) / v)^2 per square of lambda f / D, v = pi r.
  for (int i = 0; i < 40; ++i) {
    const double r = 0.1 * i + 0.05, half = field.sample() / 2;
    share_at[i] = field.share(r * cycles - half, r * cycles + half, -half, half) / std::pow(2 * half / cycles, 2);
    const double v = glm::pi<double>() * r, airy = glm::pi<double>() / 4 * std::pow(2 * std::cyl_bessel_j(1.0, v) / v, 2);
    EXPECT_NEAR(share_at[i], airy, 0.01) << r;
  }
  EXPECT_LT(share_at[11] + share_at[12], 0.01 * share_at[0]) << "first zero at 1.22";
  EXPECT_GT(share_at[16], 0.015 * share_at[0]) << "first bright ring at 1.64: 1.75 %";
}

TEST(ApertureFarField, TheCirclesTailFallsAsItShould) {
  // Outside r, on average, 2 / (pi^2 r) of the light (Born & Wolf, 8.5.2): as far as fading lets it be seen.
  const ApertureFarField field(circle_aperture(1024), 2048);
  constexpr double kStep = 0.5, kOuter = 1.2, kCycles = 1 / 0.98;
  for (const double r : {20.0, 60.0, 150.0, 300.0}) {
    double ring = 0;
    for (double x = 0; x < 400; x += kStep)
      for (double y = 0; y < 400; y += kStep) {
        const double radius = std::hypot(x + kStep / 2, y + kStep / 2) / kCycles;
        if (radius > r && radius < kOuter * r) ring += 2 * both_halves(field, x, x + kStep, y, y + kStep);
      }
    const double expected = 2 / (glm::pi<double>() * glm::pi<double>()) * (1 / r - 1 / (kOuter * r));
    EXPECT_NEAR(ring / expected, 1.0, 0.01) << r;
  }
}

TEST(ApertureFarField, ASlitMakesSincSquared) {
  const ApertureFarField field(rectangle(256, 0, 96, 256, 64), 4096);
  const auto sinc2 = [](double x) {
    return x == 0 ? 1.0 : std::pow(std::sin(glm::pi<double>() * x) / (glm::pi<double>() * x), 2);
  };
  const double d = field.sample();
  const double middle = 2 * field.share(0, d / 2, -d / 2, d / 2);
  for (int i = 1; i < 80; ++i) {
    const double along = field.share((i - 0.5) * d, (i + 0.5) * d, -d / 2, d / 2);
    const double across = 2 * field.share(0, d / 2, (i - 0.5) * d, (i + 0.5) * d);
    // Edges along the pixels' own alias in step: 1 + 2 / 3 (pi f)^2 at f cycles a pixel.
    const double f = i * d / 256, aliased = 1 + 2.0 / 3 * std::pow(glm::pi<double>() * f, 2);
    EXPECT_NEAR(along / middle, sinc2(i * d) * aliased, 1e-5) << i * d;
    EXPECT_NEAR(across / middle, sinc2(i * d / 4) * aliased, 1e-5) << "a quarter as tall: four times as wide, " << i * d;
  }
}

TEST(ApertureFarField, AllLightGoesSomewhere) {
  // Undoing the pixels' mean also raises what aliases: more, the more there is that is finer than a pixel.
  for (const Image& aperture : {circle_aperture(512), dusty_aperture(1024), eyelash_aperture(512)}) {
    const ApertureFarField field(aperture, 1024);
    const double all = 2 * field.share(0, field.limit(), -field.limit(), field.limit());
    EXPECT_GT(all, 0.9999);
    EXPECT_LT(all, 1.015);
  }
}

TEST(ApertureFarField, AShiftedApertureDiffractsAlike) {
  const ApertureFarField here(rectangle(128, 10, 20, 40, 30), 512), there(rectangle(128, 70, 61, 40, 30), 512);
  for (double x = 0; x < 20; x += 1.3)
    for (double y = -20; y < 20; y += 1.7) EXPECT_NEAR(here.share(x, x + 1, y, y + 1), there.share(x, x + 1, y, y + 1), 1e-7);
}

TEST(AperturePsf, StraightBladesMakeANeedleEachWayAcrossEveryEdge) {
  for (const auto& [blades, expected] : {std::pair{4, 4}, {5, 10}, {6, 6}, {7, 14}, {8, 8}, {9, 18}}) {
    const ApertureFarField field(diaphragm_aperture({.blades = blades, .curvature = 0}, 1024), 2048);
    const Image psf = monochromatic_psf(field, kOptics, 550, 150);
    EXPECT_EQ(needles(by_direction(psf, 40, 140, 180)).size(), static_cast<std::size_t>(expected)) << blades << " blades";
  }
}

TEST(AperturePsf, NeedlesTurnWithTheAperture) {
  const auto first_needle = [](double rotation_deg) {
    const ApertureFarField field(diaphragm_aperture({.blades = 6, .curvature = 0, .rotation_deg = rotation_deg}, 1024), 2048);
    return needles(by_direction(monochromatic_psf(field, kOptics, 550, 150), 40, 140, 180)).front();
  };
  const int at_0 = first_needle(4);  // bins of 2 degrees
  EXPECT_EQ(first_needle(14), at_0 + 5);
  EXPECT_EQ(first_needle(24), at_0 + 10);
}

TEST(AperturePsf, AQuarterTurnOfTheApertureIsAQuarterTurnOfThePsf) {
  const Image upright = eyelash_aperture(256);
  Image turned(256, 256, 1);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) *turned.pixel(255 - y, x) = *upright.pixel(x, y);
  const Image a = aperture_psf(ApertureFarField(upright, 512), kOptics, 40),
              b = aperture_psf(ApertureFarField(turned, 512), kOptics, 40);
  for (int y = 0; y < 81; ++y)
    for (int x = 0; x < 81; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(b.pixel(80 - y, x)[c], a.pixel(x, y)[c], 1e-6) << x << ' ' << y;
}

TEST(AperturePsf, TheWavelengthScalesItExactly) {
  const ApertureFarField field(dusty_aperture(512), 1024);
  const Image psf = monochromatic_psf(field, kOptics, 250, 40), longer = monochromatic_psf(field, kOptics, 750, 121);
  const Image elsewhere = monochromatic_psf(field, {.aperture_mm = 0.5, .focal_px = 3000}, 250, 121);
  for (std::size_t i = 0; i < longer.data.size(); ++i) ASSERT_NEAR(longer.data[i], elsewhere.data[i], 1e-9);
  // A pixel's light at 250 nm falls into 3 x 3 pixels at 750 nm: three times the size, a ninth of the intensity.
  for (int y = -40; y <= 40; ++y)
    for (int x = -40; x <= 40; ++x) {
      double spread = 0;
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u) spread += *longer.pixel(121 + 3 * x + u, 121 + 3 * y + v);
      ASSERT_NEAR(spread, *psf.pixel(40 + x, 40 + y), 1e-7) << x << ' ' << y;
    }
}

TEST(AperturePsf, WhiteLightStaysWhiteAndNoneIsLost) {
  for (const int reach : {1, 20, 150}) {
    const Image psf = aperture_psf(ApertureFarField(eyelash_aperture(512), 1024), kOptics, reach);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum(psf, c), 1.0, 1e-6) << "a grey world stays grey";
    for (const float value : psf.data) ASSERT_GE(value, 0.0f);
  }
}

TEST(AperturePsf, RedReachesFurtherThanBlue) {
  const Image glare = glare_of(aperture_psf(ApertureFarField(circle_aperture(512), 1024), kOptics, 60));
  EXPECT_GT(sum(glare, 0), 1.1 * sum(glare, 1));
  EXPECT_GT(sum(glare, 1), 1.1 * sum(glare, 2));
}

TEST(AperturePsf, ItsSizeInPixelsGoesWithTheFocalLengthAndTheFrame) {
  // The same picture at twice the resolution: a quarter of the light in each pixel.
  const ApertureFarField field(circle_aperture(1024), 2048);
  const Image small = aperture_psf(field, kOptics, 40), large = aperture_psf(field, {.aperture_mm = 0.5, .focal_px = 2000}, 80);
  const auto around = [](const Image& psf, int x, int half) {
    double total = 0;
    for (int v = -half; v <= half; ++v)
      for (int u = -half; u <= half; ++u) total += psf.pixel(psf.width / 2 + x + u, psf.height / 2 + v)[1];
    return total / ((2 * half + 1) * (2 * half + 1));
  };
  for (const int x : {10, 20, 30}) EXPECT_NEAR(4 * around(large, 2 * x, 6) / around(small, x, 3), 1.0, 0.06) << x;
}

TEST(AperturePsf, PlansForEveryCameraAreSane) {
  for (const double mm : {0.05, 0.5, 2.0, 20.0, 200.0})
    for (const double focal : {1.0, 100.0, 1000.0, 20000.0})
      for (const int reach : {1, 100, 8000})
        for (const int picture : {1, 64, 5000}) {
          const AperturePlan plan = plan_aperture({mm, focal}, reach, picture);
          EXPECT_GE(plan.picture_px, 1);
          EXPECT_LE(plan.picture_px, std::min(picture, 4096));
          EXPECT_LE(plan.transform_px, 8192);
          EXPECT_GE(plan.transform_px, plan.picture_px);
          EXPECT_GE(plan.reach_px, 1);
          EXPECT_LE(plan.reach_px, reach);
        }
}

TEST(AperturePsf, RefusesWhatIsNoAperture) {
  EXPECT_THROW(ApertureFarField(Image(8, 9, 1), 16), Error);
  EXPECT_THROW(ApertureFarField(Image(8, 8, 3), 16), Error);
  EXPECT_THROW(ApertureFarField(Image(8, 8, 1), 16), Error) << "black";
  Image nan = rectangle(8, 0, 0, 8, 8);
  nan.data[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(ApertureFarField(nan, 16), Error);
  EXPECT_THROW(plan_aperture({0, 1000}, 10, 512), Error);
  EXPECT_THROW(plan_aperture({2, std::numeric_limits<double>::quiet_NaN()}, 10, 512), Error);
}

}  // namespace
}  // namespace catchlight::render
