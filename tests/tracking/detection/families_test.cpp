// The layout of every family against the library's own drawing of it.
#include "tracking/detection/families.hpp"
#include "catchlight/error.hpp"

#include <apriltag/apriltag.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace catchlight::tracking {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class EveryFamily : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryFamily, LayoutIsWhatTheLibraryDraws) {
  const FamilyPtr family = create_family(GetParam());
  for (const std::uint32_t id : {0u, 7u, family->ncodes - 1}) {
    const TagLayout layout = tag_layout(GetParam(), static_cast<int>(id));
    image_u8_t* drawing = apriltag_to_image(family.get(), id);
    ASSERT_EQ(layout.side(), drawing->width);
    for (int row = 0; row < layout.side(); ++row)
      for (int column = 0; column < layout.side(); ++column) {
        const Ink ink = layout.at(column - layout.margin, row - layout.margin);
        if (ink == Ink::unknown) continue;
        EXPECT_EQ(ink == Ink::white, drawing->buf[row * drawing->stride + column] > 127) << row << ", " << column;
      }
    std::free(drawing->buf);
    std::free(drawing);
  }
}

TEST_P(EveryFamily, KnowsBothRingsAndAllBits) {
  const FamilyPtr family = create_family(GetParam());
  const TagLayout layout = tag_layout(GetParam(), 0);
  std::size_t known = 0;
  for (const Ink ink : layout.cells) known += ink != Ink::unknown;
  const int n = layout.cells_across;
  EXPECT_EQ(known, family->nbits + 4 * (n - 1) + 4 * (n + 1));
  for (int i = 0; i < n; ++i) {
    EXPECT_EQ(layout.at(i, 0), layout.white_inside ? Ink::white : Ink::black);
    EXPECT_EQ(layout.at(-1, i), layout.white_inside ? Ink::black : Ink::white);
  }
}

TEST_P(EveryFamily, RefusesAnIdBeyondItsCodebook) {
  const int count = static_cast<int>(create_family(GetParam())->ncodes);
  EXPECT_NO_THROW(tag_layout(GetParam(), count - 1));
  EXPECT_THROW(tag_layout(GetParam(), count), Error);
  EXPECT_THROW(tag_layout(GetParam(), -1), Error);
}

INSTANTIATE_TEST_SUITE_P(Library, EveryFamily, ::testing::ValuesIn(tag_families()),
                         [](const auto& family) { return family.param; });

TEST(Families, AnUnknownNameIsAnsweredWithThoseThereAre) {
  try {
    create_family("tag37h11");
    FAIL() << "created a family that does not exist";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("tag37h11"), HasSubstr("tag36h11"), HasSubstr("tagStandard52h13")));
  }
}

}  // namespace
}  // namespace catchlight::tracking
