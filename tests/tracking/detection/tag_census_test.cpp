// What is said to be in pictures.
#include "tracking/detection/tag_census.hpp"
#include "tests/support/synthetic_tag.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace catchlight::tracking {
namespace {

/// Tags of 60 px side by side.
SyntheticFrame picture_of(const std::vector<PrintedTag>& tags) {
  SyntheticScene scene{plain_camera(), {}};
  for (std::size_t i = 0; i < tags.size(); ++i)
    scene.tags.push_back({{tags[i], {}}, tag_pose(scene.camera, {120 + 180 * static_cast<double>(i), 240}, 0.8, {10, 5, 20})});
  return render(scene);
}

std::vector<LumaView> views_of(const std::vector<SyntheticFrame>& pictures) {
  std::vector<LumaView> views;
  for (const SyntheticFrame& picture : pictures) views.push_back(picture.luma());
  return views;
}

const PrintedTag kTwelve{"tag36h11", 12, 0.08}, kThree{"tag25h9", 3, 0.08}, kStandard{"tagStandard41h12", 7, 0.08};

TEST(TagCensus, CountsTagsOfEveryFamilyTheMostFrequentFirst) {
  const std::vector<SyntheticFrame> pictures{picture_of({kThree}), picture_of({kStandard, kThree}),
                                             picture_of({kThree, kStandard, kTwelve})};
  const TagCensus census = count_tags(views_of(pictures));
  EXPECT_EQ(census.pictures, 3u);
  EXPECT_FALSE(census.is_mirrored);
  EXPECT_EQ(census.tags, (std::vector<CountedTag>{{"tag25h9", 3, 3}, {"tagStandard41h12", 7, 2}}))
      << "what is in one of several pictures alone may be a chance pattern";
}

TEST(TagCensus, OnePictureIsEnoughWhereThereIsNoOther) {
  const std::vector<SyntheticFrame> pictures{picture_of({kTwelve})};
  EXPECT_EQ(count_tags(views_of(pictures)).tags, (std::vector<CountedTag>{{"tag36h11", 12, 1}}));
}

TEST(TagCensus, NoTagIsNone) {
  const std::vector<SyntheticFrame> pictures{picture_of({}), picture_of({})};
  const TagCensus census = count_tags(views_of(pictures));
  EXPECT_TRUE(census.tags.empty());
  EXPECT_FALSE(census.is_mirrored);
}

/// A camera that faces its user often records as a mirror shows.
TEST(TagCensus, MirroredTagsAreKnownToBe) {
  SyntheticFrame picture = picture_of({kTwelve});
  for (int row = 0; row < picture.height_px; ++row) {
    const auto first = picture.codes.begin() + static_cast<std::ptrdiff_t>(row) * picture.width_px;
    std::reverse(first, first + picture.width_px);
  }
  const TagCensus census = count_tags({picture.luma()});
  EXPECT_EQ(census.tags, (std::vector<CountedTag>{{"tag36h11", 12, 1}}));
  EXPECT_TRUE(census.is_mirrored);
}

}  // namespace
}  // namespace catchlight::tracking
