// The blurred print against a convolution by brute force of the AprilTag library's own drawing.
#include "tracking/refinement/tag_pattern.hpp"
#include "catchlight/track.hpp"

#include <apriltag/apriltag.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

namespace catchlight::tracking {
namespace {

struct FreeImage {
  void operator()(image_u8_t* image) const {
    std::free(image->buf);
    std::free(image);
  }
};

/// The library's drawing under a Gaussian: rows of cells exactly by erf, across the rows by Simpson's rule.
class BruteForce {
 public:
  BruteForce(const char* family_name, std::uint32_t id) : family_(create_family(family_name)) {
    image_.reset(apriltag_to_image(family_.get(), id));
    margin_ = (family_->total_width - family_->width_at_border) / 2;
  }

  double white(const glm::dvec2& cell, const Covariance2& blur) const {
    const double sigma_v = std::sqrt(blur.yy);
    double sum = 0;
    for (int row = static_cast<int>(std::floor(cell.y - 7 * sigma_v)); row <= cell.y + 7 * sigma_v; ++row) {
      constexpr int kSteps = 96;
      for (int i = 0; i <= kSteps; ++i) {
        const double weight = i == 0 || i == kSteps ? 1 : i % 2 ? 4 : 2;
        const double away = (row + static_cast<double>(i) / kSteps - cell.y) / sigma_v;
        sum += weight / (3 * kSteps) * std::exp(-away * away / 2) / (sigma_v * std::sqrt(2 * std::numbers::pi)) *
               white_of_row(row, cell.x + blur.xy / blur.yy * away * sigma_v, std::sqrt(blur.xx - blur.xy * blur.xy / blur.yy));
      }
    }
    return sum;
  }

 private:
  bool is_white(int column, int row) const {
    const int x = column + margin_, y = row + margin_;
    return x < 0 || y < 0 || x >= image_->width || y >= image_->height || image_->buf[y * image_->stride + x] > 127;
  }

  double white_of_row(int row, double middle, double sigma) const {
    double sum = 0;
    for (int column = static_cast<int>(std::floor(middle - 7 * sigma)); column <= middle + 7 * sigma; ++column)
      if (is_white(column, row))
        sum += (std::erf((column + 1 - middle) / sigma / std::numbers::sqrt2) -
                std::erf((column - middle) / sigma / std::numbers::sqrt2)) /
               2;
    return sum;
  }

  FamilyPtr family_;
  std::unique_ptr<image_u8_t, FreeImage> image_;
  int margin_ = 0;
};

/// Round, stretched along u, and smeared along both diagonals: rho = 0, 0, 0.8, -0.97.
const Covariance2 kBlurs[] = {{0.04, 0, 0.04}, {0.16, 0, 0.16}, {0.5, 0, 0.05}, {0.25, 0.16, 0.16}, {0.3, -0.29, 0.3}};

/// Lines further off than 3.5 standard deviations are left out: at most four at once, two to a side of either axis.
constexpr double kOutOfReach = 3.5, kLinesLeftOut = 4;

double density(double x) {
  return std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi);
}

const double kValueTolerance = kLinesLeftOut * std::erfc(kOutOfReach / std::numbers::sqrt2) / 2;

std::vector<glm::dvec2> places(const TagPattern& pattern, int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-pattern.margin() - 1.5, pattern.cells_across() + pattern.margin() + 1.5);
  std::vector<glm::dvec2> places;
  for (int i = 0; i < count; ++i) places.emplace_back(anywhere(random), anywhere(random));
  return places;
}

class TagPatternOf : public ::testing::TestWithParam<const char*> {};

TEST_P(TagPatternOf, IsThePrintConvolvedWithTheBlur) {
  const TagPattern pattern(tag_layout(GetParam(), 3));
  const BruteForce print(GetParam(), 3);
  for (const Covariance2& blur : kBlurs) {
    int known = 0;
    for (const glm::dvec2& cell : places(pattern, 400)) {
      const PatternSample sample = pattern.sample(cell, blur);
      if (!sample.known || known == 25) continue;
      ++known;
      EXPECT_NEAR(sample.white, print.white(cell, blur), kValueTolerance)
          << "cell " << cell.x << ", " << cell.y << ", blur " << blur.xx << " " << blur.xy << " " << blur.yy;
    }
    EXPECT_EQ(known, 25) << "or nothing was compared";
  }
}

TEST_P(TagPatternOf, DerivativesAreThoseOfTheConvolution) {
  const TagPattern pattern(tag_layout(GetParam(), 3));
  const BruteForce print(GetParam(), 3);
  constexpr double kStep = 2e-3;
  for (const Covariance2& blur : kBlurs)
    for (const glm::dvec2& cell : places(pattern, 12)) {
      const PatternSample sample = pattern.sample(cell, blur);
      if (!sample.known) continue;
      const auto at = [&](double u, double v) { return print.white(cell + kStep * glm::dvec2(u, v), blur); };
      const double su = std::sqrt(blur.xx), sv = std::sqrt(blur.yy);
      const double slope = kLinesLeftOut * density(kOutOfReach), bend = kOutOfReach * slope;
      EXPECT_NEAR(sample.gradient.x, (at(1, 0) - at(-1, 0)) / (2 * kStep), slope / su);
      EXPECT_NEAR(sample.gradient.y, (at(0, 1) - at(0, -1)) / (2 * kStep), slope / sv);
      EXPECT_NEAR(sample.uu, (at(1, 0) - 2 * at(0, 0) + at(-1, 0)) / (kStep * kStep), bend / blur.xx);
      EXPECT_NEAR(sample.vv, (at(0, 1) - 2 * at(0, 0) + at(0, -1)) / (kStep * kStep), bend / blur.yy);
      EXPECT_NEAR(sample.uv, (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * kStep * kStep), bend / (su * sv));
    }
}

TagLayout quarter_turned(const TagLayout& layout) {
  TagLayout turned = layout;
  const int side = layout.side();
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      turned.cells[static_cast<std::size_t>(column * side + side - 1 - row)] =
          layout.cells[static_cast<std::size_t>(row * side + column)];
  return turned;
}

TEST_P(TagPatternOf, AQuarterTurnOfThePrintTurnsTheSample) {
  const TagLayout layout = tag_layout(GetParam(), 3);
  const TagPattern pattern(layout), turned(quarter_turned(layout));
  const Covariance2 blur{0.25, 0.16, 0.16}, turned_blur{blur.yy, -blur.xy, blur.xx};
  int known = 0;
  for (const glm::dvec2& cell : places(pattern, 60)) {
    const PatternSample a = pattern.sample(cell, blur), b = turned.sample({pattern.cells_across() - cell.y, cell.x}, turned_blur);
    ASSERT_EQ(a.known, b.known);
    known += a.known;
    EXPECT_EQ(a.edge, b.edge);
    // The table of the normal distribution is good to 1e-6, and a few lines add up.
    EXPECT_NEAR(a.white, b.white, 1e-5);
    EXPECT_NEAR(a.gradient.x, b.gradient.y, 1e-4);
    EXPECT_NEAR(a.gradient.y, -b.gradient.x, 1e-4);
    EXPECT_NEAR(a.uu, b.vv, 1e-3);
    EXPECT_NEAR(a.vv, b.uu, 1e-3);
    EXPECT_NEAR(a.uv, -b.uv, 1e-3);
  }
  EXPECT_GE(known, 8);
}

/// A plain one, data outside the square, unknown cells in the corners, and unknown cells in the middle.
/// One corner is all that a blur of less than half a cell's reach can see, more come into sight beyond: both ways say the same.
TEST_P(TagPatternOf, NothingJumpsWhereMoreThanOneCornerComesIntoSight) {
  const TagPattern pattern(tag_layout(GetParam(), 0));
  constexpr double kSigma = 0.5 / 3.5;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, pattern.cells_across());
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec2 cell(place(random), place(random));
    const auto sampled = [&](double sigma) { return pattern.sample(cell, {sigma * sigma, 0.2 * sigma * sigma, sigma * sigma}); };
    const PatternSample one = sampled(kSigma * (1 - 1e-9)), many = sampled(kSigma * (1 + 1e-9));
    ASSERT_EQ(one.known, many.known) << cell.x << ", " << cell.y;
    if (!one.known) continue;
    ASSERT_EQ(one.edge, many.edge) << cell.x << ", " << cell.y;
    EXPECT_NEAR(one.white, many.white, 1e-6);
    EXPECT_NEAR(one.gradient.x, many.gradient.x, 1e-5);
    EXPECT_NEAR(one.gradient.y, many.gradient.y, 1e-5);
    EXPECT_NEAR(one.uu, many.uu, 1e-4);
    EXPECT_NEAR(one.uv, many.uv, 1e-4);
    EXPECT_NEAR(one.vv, many.vv, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, TagPatternOf,
                         ::testing::Values("tag36h11", "tag16h5", "tagStandard41h12", "tagCircle21h7", "tagCustom48h12"),
                         [](const auto& family) { return std::string(family.param); });

TEST(TagPattern, PaperBeyondThePrintIsWhite) {
  const TagPattern pattern(tag_layout("tag36h11", 0));
  for (const glm::dvec2 cell : {glm::dvec2(-40, 4), glm::dvec2(4, 300), glm::dvec2(-9, -9)}) {
    const PatternSample sample = pattern.sample(cell, {0.3, 0.1, 0.3});
    EXPECT_TRUE(sample.known);
    EXPECT_FALSE(sample.edge);
    EXPECT_EQ(sample.white, 1);
    EXPECT_EQ(sample.gradient, glm::dvec2(0));
    EXPECT_EQ(pattern.around(cell, {1, 1}), TagPattern::Neighbourhood::plateau);
  }
}

TEST(TagPattern, TheMiddleOfABorderCellIsAPlateauUntilBlurReachesItsEdge) {
  const TagPattern pattern(tag_layout("tag36h11", 0));
  const PatternSample sharp = pattern.sample({4, 0.5}, {0.01, 0, 0.01});
  EXPECT_FALSE(sharp.edge);
  EXPECT_EQ(sharp.white, 0);
  EXPECT_EQ(pattern.around({4, 0.5}, {0.4, 0.4}), TagPattern::Neighbourhood::plateau);
  EXPECT_TRUE(pattern.sample({4, 0.5}, {0.04, 0, 0.04}).edge);
  EXPECT_EQ(pattern.around({4, 0.5}, {0.4, 0.6}), TagPattern::Neighbourhood::edge);
}

TEST(TagPattern, OnAStraightEdgeHalfTheWhiteIsSeen) {
  // The top border's outer edge, three standard deviations from the tag's corners and data.
  const TagPattern pattern(tag_layout("tag36h11", 0));
  const double sigma = 0.25;
  const PatternSample sample = pattern.sample({4, 0}, {sigma * sigma, 0, sigma * sigma});
  EXPECT_NEAR(sample.white, 0.5, 1e-6);
  EXPECT_NEAR(sample.gradient.y, -density(0) / sigma, 1e-6) << "from white paper into black";
  EXPECT_NEAR(sample.gradient.x, 0, 1e-12);
}

TEST(TagPattern, UnknownCellsMakeAPlaceUnknown) {
  const TagLayout layout = tag_layout("tagCircle21h7", 0);
  const TagPattern pattern(layout);
  const glm::dvec2 corner(-layout.margin + 0.5, -layout.margin + 0.5);
  ASSERT_EQ(layout.at(-layout.margin, -layout.margin), Ink::unknown) << "a circle has no corners";
  EXPECT_FALSE(pattern.sample(corner, {0.01, 0, 0.01}).known);
  EXPECT_EQ(pattern.around(corner, {0.1, 0.1}), TagPattern::Neighbourhood::unknown);
  EXPECT_EQ(pattern.around(corner - glm::dvec2(0.7, 0), {0.3, 0.3}), TagPattern::Neighbourhood::unknown) << "within reach";
  EXPECT_EQ(pattern.around(corner - glm::dvec2(0.7, 0), {0.1, 0.1}), TagPattern::Neighbourhood::plateau) << "out of reach";
}

}  // namespace
}  // namespace catchlight::tracking
