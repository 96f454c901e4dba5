// Pictures in any number of files: lists, globs and patterns with gaps.
#include "app/media/read/picture_list.hpp"
#include "catchlight/error.hpp"
#include "tests/support/media_fixture.hpp"

#include <gmock/gmock.h>

namespace catchlight::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class PictureList : public MediaTest {
 protected:
  /// A grey picture of that luma.
  void make(const std::string& name, int luma, const std::string& size = "16x16") {
    ffmpeg("-f lavfi -i color=c=gray:s=" + size + ",format=gray,geq=lum=" + std::to_string(luma) + " -frames:v 1 " + path(name));
  }

  std::vector<std::pair<std::int64_t, int>> numbers_and_lumas(const std::vector<std::string>& names) {
    std::vector<std::string> paths;
    for (const std::string& name : names) paths.push_back(path(name));
    const auto source = open_footage_or_pictures(paths);
    std::vector<std::pair<std::int64_t, int>> frames;
    while (auto frame = source->read()) frames.emplace_back(frame->number(), frame->luma().data[0]);
    return frames;
  }
};

TEST_F(PictureList, APatternMayHaveGapsAndKeepsItsNumbers) {
  for (const int number : {1, 2, 4}) make("left0" + std::to_string(number) + ".png", 10 * number);
  EXPECT_THAT(numbers_and_lumas({"left%02d.png"}), ElementsAre(std::pair(1, 10), std::pair(2, 20), std::pair(4, 40)));
}

TEST_F(PictureList, NamesAndGlobsAreInTheOrderOfTheirNumbers) {
  for (const int number : {2, 9, 10}) make("b" + std::to_string(number) + ".png", number);
  const auto ordered = ElementsAre(std::pair(2, 2), std::pair(9, 9), std::pair(10, 10));
  EXPECT_THAT(numbers_and_lumas({"b*.png"}), ordered);
  EXPECT_THAT(numbers_and_lumas({"b10.png", "b9.png", "b2.png"}), ordered);
}

TEST_F(PictureList, NamesWithoutNumbersAreCounted) {
  make("near.png", 50);
  make("far.png", 60);
  make("far.2.png", 70);
  EXPECT_THAT(numbers_and_lumas({"near.png", "far.png", "far.2.png"}),
              ElementsAre(std::pair(0, 50), std::pair(1, 60), std::pair(2, 70)));
}

TEST_F(PictureList, OneNameIsFootageAsEver) {
  make("a0.png", 5);
  make("a1.png", 6);
  EXPECT_THAT(numbers_and_lumas({"a0.png"}), ElementsAre(std::pair(0, 5)));
  EXPECT_THAT(numbers_and_lumas({"a%d.png"}), ElementsAre(std::pair(0, 5), std::pair(1, 6)));
  EXPECT_THAT(message_of<Error>([&] { numbers_and_lumas({"c%d.png"}); }), HasSubstr("no file matches"));
  EXPECT_THAT(message_of<Error>([&] { numbers_and_lumas({"c*.png"}); }), HasSubstr("no file matches"));
}

TEST_F(PictureList, PicturesAreOfOneSizeAndNoVideos) {
  make("a.png", 5);
  make("b.png", 5, "32x16");
  EXPECT_THAT(message_of<Error>([&] { numbers_and_lumas({"a.png", "b.png"}); }), HasSubstr("b.png: is 32x16, but"));
  ffmpeg("-f lavfi -i testsrc=s=16x16 -frames:v 3 " + path("v.mkv"));
  EXPECT_THAT(message_of<Error>([&] { numbers_and_lumas({"a.png", "v.mkv"}); }), HasSubstr("v.mkv: is a video"));
}

}  // namespace
}  // namespace catchlight::app::testing
