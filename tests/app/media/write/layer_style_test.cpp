#include "app/media/write/layer_style.hpp"

#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;

constexpr int kWidth = 40, kHeight = 30;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

CameraModel camera() {
  return {.width_px = kWidth, .height_px = kHeight, .fx_px = 50, .fy_px = 50, .cx_px = 19.5, .cy_px = 14.5};
}

/// Depth 2 m at one pixel, nothing elsewhere.
Image one_point(int x, int y) {
  Image depth(kWidth, kHeight, 1);
  for (float& value : depth.data) value = kInfinity;
  depth.data[static_cast<std::size_t>(y * kWidth + x)] = 2;
  return depth;
}

std::vector<float> at(const Image& image, int x, int y) {
  const auto first = image.data.begin() + static_cast<std::ptrdiff_t>((y * image.width + x) * image.channels);
  return {first, first + image.channels};
}

/// The camera stands still and what it sees moves by these metres in its frame: f d / z pixels, and y is up in the offset.
RigidTransform moved(const glm::dvec3& by_m) {
  return {glm::dmat3(1.0), by_m};
}

TEST(OffsetPx, APointThatMovesAcrossMovesByFocalLengthOverDepth) {
  const Image offset = offset_px(one_point(10, 20), camera(), {}, moved({0.08, 0.04, 0}));
  EXPECT_THAT(at(offset, 10, 20), ElementsAre(FloatNear(2, 1e-4f), FloatNear(-1, 1e-4f)));
  EXPECT_THAT(at(offset, 11, 20), ElementsAre(0, 0)) << "nothing is there";
}

TEST(OffsetPx, APointThatComesNearerLeavesTheMiddle) {
  // From 2 m to 1 m everything is twice as far from the principal point.
  const Image offset = offset_px(one_point(10, 20), camera(), {}, moved({0, 0, -1}));
  EXPECT_THAT(at(offset, 10, 20), ElementsAre(FloatNear(10 - 19.5f, 1e-4f), FloatNear(14.5f - 20, 1e-4f)));
}

TEST(OffsetPx, WhatComesBehindTheOtherCameraHasNone) {
  EXPECT_THAT(at(offset_px(one_point(10, 20), camera(), {}, moved({0, 0, -3})), 10, 20), ElementsAre(0, 0));
}

TEST(OffsetPx, TheLensBendsBothPlacesAlike) {
  CameraModel bent = camera();
  bent.distortion = {-0.2, 0.05};
  EXPECT_THAT(at(offset_px(one_point(3, 4), bent, {}, {}), 3, 4), ElementsAre(FloatNear(0, 1e-4f), FloatNear(0, 1e-4f)));
}

TEST(MotionLayers, NukeHasOffsetsToBothFramesAndBlenderThePathThroughThree) {
  Image backward(1, 1, 2), forward(1, 1, 2);
  backward.data = {-3, 1};
  forward.data = {4, -2};
  const auto nuke = motion_layers(LayerStyle::nuke, backward, forward);
  ASSERT_EQ(nuke.size(), 2u);
  EXPECT_EQ(nuke[0].name, "forward");
  EXPECT_THAT(at(nuke[0].image, 0, 0), ElementsAre(4, -2));
  EXPECT_EQ(nuke[1].name, "backward");
  EXPECT_THAT(at(nuke[1].image, 0, 0), ElementsAre(-3, 1));
  const auto blender = motion_layers(LayerStyle::blender, backward, forward);
  ASSERT_EQ(blender.size(), 1u);
  EXPECT_THAT(at(blender[0].image, 0, 0), ElementsAre(-3, 1, -4, 2));
  EXPECT_TRUE(motion_layers(LayerStyle::plain, backward, forward).empty());
}

/// A camera over a tag on a table looks straight down; the picture's top is the tag's +y.
TEST(StyledNormals, AFaceThatLooksAtTheCameraLooksAlongItsAxis) {
  const RigidTransform camera_from_tag{glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1)), {0, 0, 1}};
  // Tag on a table: world x, y, z = tag x, z, -y.
  const glm::dmat3 world_from_tag(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0));
  Image normals(2, 1, 3);
  normals.data = {0, 0, -1, 0, -1, 0};  // up, and towards the picture's top
  const auto styled = [&](LayerStyle style) {
    return styled_normals(normals, {.style = style, .camera = camera(), .world_from_tag = world_from_tag}, camera_from_tag);
  };
  EXPECT_EQ(styled(LayerStyle::plain).data, normals.data);
  EXPECT_THAT(at(styled(LayerStyle::nuke), 0, 0), ElementsAre(0, 0, 1));
  EXPECT_THAT(at(styled(LayerStyle::nuke), 1, 0), ElementsAre(0, 1, 0));
  EXPECT_THAT(at(styled(LayerStyle::blender), 0, 0), ElementsAre(0, 0, 1)) << "Blender's z is up";
  EXPECT_THAT(at(styled(LayerStyle::blender), 1, 0), ElementsAre(0, 1, 0)) << "tag +y is Blender's y";
}

}  // namespace
}  // namespace catchlight::app
