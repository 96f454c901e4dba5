#include "catchlight/util/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace catchlight {
namespace {

/// The definition, without the table: exponential, for short words.
std::size_t edit_distance_by_definition(std::string_view a, std::string_view b) {
  if (a.empty()) return b.size();
  if (b.empty()) return a.size();
  const std::size_t replaced = edit_distance_by_definition(a.substr(1), b.substr(1)) + (a[0] == b[0] ? 0 : 1);
  const std::size_t deleted = edit_distance_by_definition(a.substr(1), b) + 1;
  const std::size_t inserted = edit_distance_by_definition(a, b.substr(1)) + 1;
  return std::min({replaced, deleted, inserted});
}

TEST(EditDistance, KnownPairs) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("enabld", "enabled"), 1u);
  EXPECT_EQ(edit_distance("same", "same"), 0u);
}

TEST(EditDistance, EqualsItsDefinitionOnShortWords) {
  std::mt19937 random(7);
  const auto word = [&] {
    std::string text(random() % 6, ' ');
    for (char& c : text) c = static_cast<char>('a' + random() % 3);
    return text;
  };
  for (int i = 0; i < 300; ++i) {
    const std::string a = word(), b = word();
    EXPECT_EQ(edit_distance(a, b), edit_distance_by_definition(a, b)) << '"' << a << "\" and \"" << b << '"';
  }
}

TEST(Nearest, PrefersTheSameLastPartOverFewerEdits) {
  const std::vector<std::string> names{"glare", "glare.enabled", "probe.ev", "exposure.ev"};
  EXPECT_EQ(nearest("glare.enabld", names), "glare.enabled");
  EXPECT_EQ(nearest("enabled", names), "glare.enabled");
  EXPECT_EQ(nearest("glaree", names), "glare");
}

TEST(NumberText, ReadsBackToTheSameBits) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 10'000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (std::isnan(value)) continue;
    const std::optional<double> back = real_from_text(number_text(value));
    ASSERT_TRUE(back.has_value()) << number_text(value);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(*back), std::bit_cast<std::uint64_t>(value)) << number_text(value);
  }
}

TEST(NumberText, IsShort) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-2.0), "-2");
  EXPECT_EQ(number_text(-0.0), "-0");
}

TEST(PlainText, HasNoExponent) {
  EXPECT_EQ(plain_text(0.0001), "0.0001");
  EXPECT_EQ(plain_text(1e-6), "0.000001");
  EXPECT_EQ(plain_text(1e6), "1000000");
  EXPECT_EQ(plain_text(0.1), "0.1");
  EXPECT_EQ(plain_text(std::numeric_limits<double>::max()).size(), 309U);
}

TEST(Counted, OneOfAThingStandsInTheSingular) {
  EXPECT_EQ(counted(1, "frame"), "1 frame");
  EXPECT_EQ(counted(0, "frame"), "0 frames");
  EXPECT_EQ(counted(12U, "frame"), "12 frames");
  EXPECT_EQ(counted(1, "vertex", "vertices") + ", " + counted(2, "vertex", "vertices"), "1 vertex, 2 vertices");
}

TEST(NumberFromText, TakesTheWholeTextOrNothing) {
  EXPECT_EQ(real_from_text("1.5"), 1.5);
  EXPECT_EQ(integer_from_text("-3"), -3);
  for (const char* text : {"", " 1", "1 ", "1,5", "0x10", "one", "1.5.2", "1e999"})
    EXPECT_FALSE(real_from_text(text)) << '"' << text << '"';
  for (const char* text : {"", "1.0", "1e3", "99999999999999999999"}) EXPECT_FALSE(integer_from_text(text)) << '"' << text << '"';
}

TEST(Split, KeepsEmptyFields) {
  EXPECT_EQ(split("a,,b,", ','), (std::vector<std::string>{"a", "", "b", ""}));
  EXPECT_EQ(split("", ','), (std::vector<std::string>{""}));
}

TEST(QuotedList, ReadsAsASentence) {
  EXPECT_EQ(quoted_list({"a"}), "\"a\"");
  EXPECT_EQ(quoted_list({"a", "b"}), "\"a\" or \"b\"");
  EXPECT_EQ(quoted_list({"a", "b", "c"}), "\"a\", \"b\" or \"c\"");
}

}  // namespace
}  // namespace catchlight
