// The table of codes to light against the formulas that it stands for.
#include "catchlight/light_table.hpp"

#include <gtest/gtest.h>

namespace catchlight {
namespace {

class LightTableOf : public ::testing::TestWithParam<TransferFunction> {};

TEST_P(LightTableOf, IsTheFormulaWithinAMillionth) {
  const CameraResponse response{GetParam()};
  const LightTable light(response);
  for (int i = -1000; i <= 12000; ++i) {
    const float code = static_cast<float>(i) / 10000;
    const double formula = linear_from_code(response, code, 0);
    EXPECT_NEAR(light(code, 0), formula, 1e-6 * std::max(1.0, std::abs(formula))) << code;
  }
}

TEST_P(LightTableOf, NeverFalls) {
  const LightTable light(CameraResponse{GetParam()});
  float before = light(0, 0);
  for (int i = 1; i <= 100'000; ++i) {
    const float here = light(static_cast<float>(i) / 100'000, 0);
    ASSERT_GE(here, before) << i;
    before = here;
  }
}

INSTANTIATE_TEST_SUITE_P(Formulas, LightTableOf,
                         ::testing::Values(TransferFunction::srgb, TransferFunction::linear, TransferFunction::gamma22,
                                           TransferFunction::gamma28, TransferFunction::pq, TransferFunction::hlg));

TEST(LightTable, ACurveIsReadItself) {
  const CameraResponse response{TransferFunction::srgb,
                                std::make_shared<ResponseCurve>(ResponseCurve::Tables{{{0, 1}, {0, 0.1f, 2}, {0, 3}}})};
  const LightTable light(response);
  for (int channel = 0; channel < 3; ++channel)
    for (const float code : {-0.1f, 0.0f, 0.3f, 0.7f, 1.0f, 1.2f})
      EXPECT_FLOAT_EQ(light(code, channel), static_cast<float>(linear_from_code(response, code, channel)));
}

}  // namespace
}  // namespace catchlight
