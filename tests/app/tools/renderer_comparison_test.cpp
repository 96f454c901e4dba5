#include "app/tools/replay/renderer_comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/media_fixture.hpp"

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A black frame of 40 x 25 pixels.
Frame black_frame() {
  FramePtr picture = testing::noise_frame(AV_PIX_FMT_RGB24, 40, 25, 1);
  for (int y = 0; y < 25; ++y) std::fill_n(picture->data[0] + y * picture->linesize[0], 3 * 40, std::uint8_t{0});
  return {std::shared_ptr<const AVFrame>(std::move(picture)), 7, 0};
}

/// `count` pixels of a row are `code`, of 255, of which all are marked as changed.
Composite row_of(int count, const glm::vec3& code) {
  Composite composite;
  composite.rect = {5, 10, count, 1};
  for (int i = 0; i < count; ++i) composite.rgba.insert(composite.rgba.end(), {code.r / 255, code.g / 255, code.b / 255, 1.0f});
  return composite;
}

TEST(CodeDifference, IsTheLargestChannelsOverAllOfTheFrame) {
  const Frame frame = black_frame();
  const CodeDifference nine = code_difference(frame, {}, row_of(9, {10, 50, 20}));
  EXPECT_NEAR(nine.mean, 9 * 50 / 1000.0, 1e-5);
  EXPECT_EQ(nine.p99, 0) << "less than a hundredth of the pixels";
  EXPECT_NEAR(code_difference(frame, {}, row_of(11, {10, 50, 20})).p99, 50, 1e-4);
  EXPECT_NEAR(code_difference(frame, row_of(11, {10, 20, 20}), row_of(11, {10, 50, 20})).p99, 30, 1e-4);
  EXPECT_EQ(code_difference(frame, row_of(30, {1, 2, 3}), row_of(30, {1, 2, 3})).mean, 0);
}

TEST(CodeDifference, LooksAtWhatIsWritten) {
  Composite unchanged = row_of(20, {90, 90, 90});
  for (std::size_t i = 3; i < unchanged.rgba.size(); i += 4) unchanged.rgba[i] = 0;
  EXPECT_EQ(code_difference(black_frame(), {}, unchanged).mean, 0) << "pixels that are not marked as changed are the plate's";
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(code_difference(black_frame(), row_of(20, {300, 260, 1e9f}), row_of(20, {256, 255, 255})).mean, 0) << "white";
  EXPECT_EQ(code_difference(black_frame(), row_of(20, {none, none, -5}), row_of(20, {0, -1, 0})).mean, 0) << "black";
}

TEST(RendererDifference, IsDriftBeyondItsBounds) {
  EXPECT_THAT(drift(RendererDifference{3, {0.3, 2}, 1, 2}), IsEmpty());
  EXPECT_THAT(drift(RendererDifference{3, {0.31, 2.5}, 1, 2}),
              ElementsAre(HasSubstr("in frame 1: mean 0.31 of 255"), HasSubstr("in frame 2: 99th percentile 2.50 of 255")));
}

}  // namespace
}  // namespace catchlight::app
