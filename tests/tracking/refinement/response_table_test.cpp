// The table against the transfer functions themselves.
#include "tracking/refinement/response_table.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/response.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace catchlight::tracking {
namespace {

LumaView footage(TransferFunction transfer, bool is_limited) {
  LumaView luma;
  luma.transfer = transfer;
  if (is_limited) luma.black_code = 16, luma.white_code = 235;
  return luma;
}

constexpr double kCodes = 0.02;  ///< what the table may be off, 8-bit codes

struct Case {
  const char* name;
  TransferFunction transfer;
  bool is_limited;
};

class ResponseTableOf : public ::testing::TestWithParam<Case> {
 protected:
  LumaView luma_ = footage(GetParam().transfer, GetParam().is_limited);
  ResponseTable table_{luma_};
};

TEST_P(ResponseTableOf, EveryCodesLightHasThatCode) {
  for (int code = 0; code < 256; ++code) {
    const double normalised = table_.normalised(static_cast<std::uint8_t>(code));
    if (luma_.transfer != TransferFunction::srgb && luma_.transfer != TransferFunction::linear && normalised < 0)
      continue;  // below black these curves are flat
    EXPECT_NEAR(table_.linear(static_cast<std::uint8_t>(code)), linear_from_code(luma_.transfer, normalised), 1e-15);
    const double back = table_.code(linear_from_code(luma_.transfer, normalised)).value;
    EXPECT_NEAR(back * table_.codes_per_unit(), normalised * table_.codes_per_unit(), kCodes) << "8-bit code " << code;
  }
}

TEST_P(ResponseTableOf, LightBetweenTwoCodesLiesBetweenThem) {
  // As curved as it gets: in the lowest codes of a power curve, where most of the codes lie in little light.
  for (double code = 0.5; code < 219; code += 0.37) {
    const double normalised = code / table_.codes_per_unit();
    const double back = table_.code(table_.linear_of(normalised)).value;
    EXPECT_NEAR(back * table_.codes_per_unit(), code, kCodes);
  }
}

TEST_P(ResponseTableOf, TheSlopeIsThatOfTheInverse) {
  for (double code = 2; code < 219; code += 0.37) {
    const double normalised = code / table_.codes_per_unit(), step = 1e-5;
    const double light_per_code =
        (linear_from_code(luma_.transfer, normalised + step) - linear_from_code(luma_.transfer, normalised - step)) / (2 * step);
    const double slope = table_.code(linear_from_code(luma_.transfer, normalised)).slope;
    EXPECT_NEAR(slope * light_per_code, 1, 0.01) << "code " << code;
  }
}

TEST_P(ResponseTableOf, BeyondItsEndsItIsClipped) {
  const double darkest = table_.linear(0), brightest = table_.linear(255);
  for (const double light : {brightest, brightest + 1e-3, brightest + 100, HUGE_VAL}) {
    EXPECT_EQ(table_.code(light).value, table_.normalised(255));
    EXPECT_EQ(table_.code(light).slope, 0);
  }
  for (const double light : {darkest, darkest - 1e-3, -HUGE_VAL}) {
    EXPECT_NEAR(linear_from_code(luma_.transfer, table_.code(light).value), darkest, 1e-12);
    EXPECT_EQ(table_.code(light).slope, 0);
  }
}

TEST_P(ResponseTableOf, NeverFalls) {
  const double darkest = table_.linear(0), range = table_.linear(255) - darkest;
  double before = table_.code(darkest).value;
  for (int i = 1; i <= 20000; ++i) {
    const double here = table_.code(darkest + range * std::pow(i / 20000.0, 4)).value;
    ASSERT_GE(here, before - 1e-6) << i;
    before = here;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Transfers, ResponseTableOf,
    ::testing::Values(Case{"srgb", TransferFunction::srgb, false}, Case{"srgb_limited", TransferFunction::srgb, true},
                      Case{"linear", TransferFunction::linear, false}, Case{"linear_limited", TransferFunction::linear, true},
                      Case{"gamma22", TransferFunction::gamma22, false}, Case{"gamma22_limited", TransferFunction::gamma22, true},
                      Case{"gamma28", TransferFunction::gamma28, false}, Case{"gamma28_limited", TransferFunction::gamma28, true},
                      Case{"pq", TransferFunction::pq, false}, Case{"pq_limited", TransferFunction::pq, true},
                      Case{"hlg", TransferFunction::hlg, false}, Case{"hlg_limited", TransferFunction::hlg, true}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(ResponseTable, LimitedRangeHasItsBlackAt16AndItsWhiteAt235) {
  const ResponseTable table(footage(TransferFunction::srgb, true));
  EXPECT_EQ(table.normalised(16), 0);
  EXPECT_EQ(table.normalised(235), 1);
  EXPECT_EQ(table.codes_per_unit(), 219);
  EXPECT_EQ(table.linear(235), 1);
  EXPECT_LT(table.linear(0), 0) << "blacker than black";
  EXPECT_GT(table.linear(255), 1) << "whiter than white";
}

TEST(ResponseTable, ServesOnlyFramesLikeItsOwn) {
  const LumaView full = footage(TransferFunction::srgb, false), limited = footage(TransferFunction::srgb, true);
  const ResponseTable table(full);
  EXPECT_TRUE(table.fits(full));
  EXPECT_FALSE(table.fits(limited));
  EXPECT_FALSE(table.fits(footage(TransferFunction::hlg, false)));
  LumaView shifted = full;
  shifted.black_code = 10, shifted.white_code = 265;
  EXPECT_FALSE(table.fits(shifted)) << "the same span elsewhere";
}

}  // namespace
}  // namespace catchlight::tracking
