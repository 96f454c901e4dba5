#include "catchlight/util/raw_vector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace catchlight {
namespace {

TEST(RawVector, LeavesMemoryAsItWas) {
  RawVector<std::byte> bytes(64, std::byte{7});
  bytes.clear();
  bytes.resize(64);  // in the memory that it already has
  EXPECT_EQ(std::ranges::count(bytes, std::byte{7}), 64);
}

TEST(RawVector, WritesValuesThatItIsGiven) {
  EXPECT_EQ(std::ranges::count(RawVector<float>(64, 0.0f), 0.0f), 64);
  RawVector<float> grown = {1.0f};
  grown.resize(3, 2.0f);
  EXPECT_EQ(grown, (RawVector<float>{1.0f, 2.0f, 2.0f}));
}

TEST(RawVector, StillMakesObjects) {
  RawVector<std::string> words(2);
  words.resize(200);
  EXPECT_EQ(std::ranges::count(words, ""), 200);
}

}  // namespace
}  // namespace catchlight
