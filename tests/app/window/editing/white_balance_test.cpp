#include "app/window/editing/white_balance.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "catchlight/color.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {
namespace {

constexpr glm::dvec3 kBlack(0.0);

double luminance(const glm::dvec3& linear) {
  return glm::dot(kLuminanceWeights, linear);
}

TEST(WhiteBalance, GivesPaperTheColourOfTheGreyAndKeepsItsLuminance) {
  const glm::dvec3 grey{0.3, 0.25, 0.15}, paper{0.5, 0.6, 0.8};
  const glm::dvec3 balanced = white_balance_for(grey, paper, kBlack) * paper;
  EXPECT_NEAR(luminance(balanced), luminance(paper), 1e-3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(balanced[c] / luminance(balanced), grey[c] / luminance(grey), 2e-3);
}

TEST(WhiteBalance, IsNoneWherePaperHasTheGreysColourAlready) {
  const glm::dvec3 paper{0.5, 0.6, 0.8};
  EXPECT_EQ(white_balance_for(0.4 * paper, paper, kBlack), glm::dvec3(1.0)) << "a grey may be darker than paper";
  const glm::dvec3 black{0.01, 0.02, 0.03};
  EXPECT_EQ(white_balance_for(0.4 * paper + black, paper, black), glm::dvec3(1.0)) << "what the lens scatters has no part in it";
}

TEST(WhiteBalance, RefusesWhatTellsNoColour) {
  const glm::dvec3 paper(0.5);
  EXPECT_THROW(white_balance_for(glm::dvec3(0.001), paper, kBlack), Error);
  EXPECT_THROW(white_balance_for(glm::dvec3(0.02), paper, glm::dvec3(0.02)), Error);
  EXPECT_THROW(white_balance_for({0.9, 0.004, 0.004}, paper, kBlack), Error) << "red is no grey";
}

Plate plate_of(const std::vector<int>& codes) {
  Plate plate{{0, 0, static_cast<int>(codes.size() / 3), 1}, Plate::Format::rgb_u8, {}};
  for (const int code : codes) plate.pixels.push_back(static_cast<std::byte>(code));
  return plate;
}

TEST(MeanLight, IsTheMeanOfLightAndNotOfCodes) {
  PlateColor color;
  color.transfer = TransferFunction::srgb;
  const glm::dvec3 mean = mean_light(plate_of({0, 0, 0, 200, 100, 50}), color);
  const int codes[] = {200, 100, 50};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], linear_from_srgb(codes[c] / 255.0) / 2, 1e-6);
}

TEST(MeanLight, RefusesAClippedPixel) {
  EXPECT_NO_THROW(mean_light(plate_of({251, 251, 251}), {}));
  EXPECT_THROW(mean_light(plate_of({100, 100, 100, 90, 252, 90}), {}), Error);
}

}  // namespace
}  // namespace catchlight::app
