// The edge model against edges made from the normal distribution function, on a ladder of blurs and noises.
#include "tracking/refinement/edge_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

namespace catchlight::tracking {
namespace {

struct TrueEdge {
  double shift_start_px = 0.31, shift_end_px = -0.22;
  double blur_px = 0.7;
  double minus = 0.03, plus = 0.6;
  double minus_change = 0, plus_change = 0;  ///< change of the plateaus along the edge
  double plus_slope = 0;                     ///< shading of the bright side, per pixel
  double noise = 0;
};

/// 60 pixels long, 5 pixels to either side, at every phase between the pixels' grid and the edge.
std::vector<EdgePixel> pixels_of(const TrueEdge& edge, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<EdgePixel> pixels;
  for (int column = 0; column < 60; ++column)
    for (int row = -5; row <= 5; ++row) {
      const double along = column / 59.0, across = row + 0.37 * column - std::floor(0.37 * column);
      const double distance = across - (edge.shift_start_px + (edge.shift_end_px - edge.shift_start_px) * along);
      const double share = 0.5 * std::erfc(-distance / (std::sqrt(2.0) * edge.blur_px));
      const double bright = edge.plus + edge.plus_change * along + edge.plus_slope * std::max(distance, 0.0);
      const double dark = edge.minus + edge.minus_change * along;
      pixels.push_back({along, across, dark + (bright - dark) * share + edge.noise * normal(random)});
    }
  return pixels;
}

TEST(EdgeFit, RecoversEveryParameterOfItsOwnModel) {
  const TrueEdge edge;
  const auto fit = fit_edge(pixels_of(edge));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->shift_start_px, edge.shift_start_px, 1e-4);
  EXPECT_NEAR(fit->shift_end_px, edge.shift_end_px, 1e-4);
  EXPECT_NEAR(fit->blur_px, edge.blur_px, 1e-4);
  EXPECT_NEAR(fit->step, edge.plus - edge.minus, 1e-4);
}

TEST(EdgeFit, ConvergesForSharpAndForBlurredEdges) {
  for (const double blur_px : {0.3, 0.5, 1.0, 1.5, 2.0}) {
    TrueEdge edge;
    edge.blur_px = blur_px;
    const auto fit = fit_edge(pixels_of(edge));
    ASSERT_TRUE(fit) << blur_px;
    EXPECT_NEAR(fit->shift_start_px, edge.shift_start_px, 1e-3) << blur_px;
    EXPECT_NEAR(fit->shift_end_px, edge.shift_end_px, 1e-3) << blur_px;
  }
}

TEST(EdgeFit, BrightOnEitherSideIsTheSame) {
  TrueEdge edge, mirrored;
  std::swap(mirrored.minus, mirrored.plus);
  const auto a = fit_edge(pixels_of(edge)), b = fit_edge(pixels_of(mirrored));
  ASSERT_TRUE(a && b);
  EXPECT_GT(a->step, 0);
  EXPECT_LT(b->step, 0);
  EXPECT_NEAR(a->shift_start_px, b->shift_start_px, 1e-3);
}

/// The Cramér-Rao bound: no unbiased estimate of all eight unknowns has a smaller standard deviation at the edge's start.
double smallest_possible_error_px(const TrueEdge& edge) {
  constexpr double TrueEdge::*kUnknowns[] = {&TrueEdge::shift_start_px, &TrueEdge::shift_end_px, &TrueEdge::blur_px,
                                             &TrueEdge::minus,          &TrueEdge::plus,         &TrueEdge::minus_change,
                                             &TrueEdge::plus_change,    &TrueEdge::plus_slope};
  TrueEdge clean = edge;
  clean.noise = 0;
  const auto at = pixels_of(clean);
  cv::Mat1d jacobian(static_cast<int>(at.size()), static_cast<int>(std::size(kUnknowns)));
  for (int k = 0; k < jacobian.cols; ++k) {
    TrueEdge moved = clean;
    moved.*kUnknowns[k] += 1e-6;
    const auto beside = pixels_of(moved);
    for (int i = 0; i < jacobian.rows; ++i) jacobian(i, k) = (beside[i].value - at[i].value) / 1e-6;
  }
  const cv::Mat1d covariance = cv::Mat(jacobian.t() * jacobian).inv();
  return edge.noise * std::sqrt(covariance(0, 0));
}

TEST(EdgeFit, ReachesTheCramerRaoBoundOnALadderOfNoise) {
  for (const double noise : {0.005, 0.02, 0.05}) {
    TrueEdge edge;
    edge.noise = noise;
    const double bound_px = smallest_possible_error_px(edge);
    double squares = 0;
    constexpr int kSeeds = 100;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const auto fit = fit_edge(pixels_of(edge, seed));
      ASSERT_TRUE(fit);
      squares += std::pow(fit->shift_start_px - edge.shift_start_px, 2);
    }
    // Three standard deviations of a standard deviation's estimate, and 5 % that robustness against outliers costs.
    EXPECT_LT(std::sqrt(squares / kSeeds), bound_px * (1 + 3 / std::sqrt(2.0 * kSeeds)) * 1.05) << noise;
  }
}

TEST(EdgeFit, ShadingOfTheBrightSideDoesNotMoveTheEdge) {
  TrueEdge edge;
  edge.plus_slope = 0.02;  // a sixth of the step across the band
  const auto fit = fit_edge(pixels_of(edge));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->shift_start_px, edge.shift_start_px, 0.01);
  EXPECT_NEAR(fit->shift_end_px, edge.shift_end_px, 0.01);
}

TEST(EdgeFit, SomethingLyingOverAQuarterOfTheEdgeIsIgnored) {
  TrueEdge edge;
  edge.noise = 0.005;
  auto pixels = pixels_of(edge);
  for (EdgePixel& pixel : pixels)
    if (pixel.along > 0.4 && pixel.along < 0.65) pixel.value = 0.3;
  const auto fit = fit_edge(pixels);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->shift_start_px, edge.shift_start_px, 0.02);
  EXPECT_NEAR(fit->shift_end_px, edge.shift_end_px, 0.02);
}

TEST(EdgeFit, RefusesWhatIsNoEdge) {
  EXPECT_FALSE(fit_edge({})) << "no pixels";
  const auto pixels = pixels_of({});
  EXPECT_FALSE(fit_edge(std::span(pixels).first(12))) << "too few pixels";

  TrueEdge flat;
  flat.minus = flat.plus = 0.4;
  EXPECT_FALSE(fit_edge(pixels_of(flat))) << "constant";
  flat.noise = 0.02;
  EXPECT_FALSE(fit_edge(pixels_of(flat))) << "noise alone";

  auto one_sided = pixels;
  std::erase_if(one_sided, [](const EdgePixel& pixel) { return pixel.across_px < 0; });
  EXPECT_FALSE(fit_edge(one_sided)) << "only one side";
}

TEST(EdgeFit, RefusesAnEdgeThatChangesItsDirection) {
  TrueEdge edge, mirrored;
  std::swap(mirrored.minus, mirrored.plus);
  auto pixels = pixels_of(edge);
  const auto other = pixels_of(mirrored);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (pixels[i].along > 0.5) pixels[i] = other[i];
  EXPECT_FALSE(fit_edge(pixels));
}

}  // namespace
}  // namespace catchlight::tracking
