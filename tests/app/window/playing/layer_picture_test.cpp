// Layers as pictures that a person can read.
#include "app/window/playing/layer_picture.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace catchlight::tests {
namespace {

using namespace catchlight::app;
using Codes = std::vector<unsigned char>;

Image row(int channels, std::initializer_list<float> values) {
  Image image(static_cast<int>(values.size()) / channels, 1, channels);
  std::ranges::copy(values, image.data.begin());
  return image;
}

constexpr float kNothing = std::numeric_limits<float>::infinity();

TEST(LayerPicture, LightIsCodedAsTheFootage) {
  const Image light = row(3, {0, 0.2f, 1, 5, 0.5f, 0});
  EXPECT_EQ(light_picture(light, {{TransferFunction::linear}}).rgb, (Codes{0, 51, 255, 255, 128, 0}));
  EXPECT_EQ(light_picture(row(3, {0.5f, 0.5f, 0.5f}), {}).rgb, (Codes{188, 188, 188}));
}

TEST(LayerPicture, NothingIsBlackWhateverTheCodesOfBlackAre) {
  const auto curve = std::make_shared<ResponseCurve>(ResponseCurve::Tables{std::vector<float>{-0.1f, 1}, {-0.1f, 1}, {-0.1f, 1}});
  EXPECT_EQ(light_picture(row(4, {0, 0, 0, 0}), {{TransferFunction::srgb, curve}}).rgb, (Codes{0, 0, 0}));
}

TEST(LayerPicture, NormalsAreColours) {
  EXPECT_EQ(normals_picture(row(3, {1, 0, -1, 0, 0, 0})).rgb, (Codes{255, 128, 0, 0, 0, 0}));
}

TEST(LayerPicture, DepthGoesFromNearToFarWithoutWhereNothingIs) {
  const Image depth = row(1, {kNothing, 0.4f, 0.5f, 0.6f});
  EXPECT_EQ(depth_range(depth).near_m, 0.4f);
  EXPECT_EQ(depth_range(depth).far_m, 0.6f);
  const Codes codes = depth_picture(depth).rgb;
  EXPECT_EQ(codes[0], 0) << "nothing";
  EXPECT_EQ(codes[3], 255) << "nearest";
  EXPECT_NEAR(codes[6], (255 + 40) / 2, 1);
  EXPECT_EQ(codes[9], 40) << "farthest, brighter than nothing";
  EXPECT_EQ(depth_range(row(1, {kNothing})).far_m, 0);
}

TEST(LayerPicture, AnUnshadowedReceiverIsLightGrey) {
  EXPECT_EQ(ratio_picture(row(3, {1, 0.5f, 2})).rgb, (Codes{kUnshadowedCode, 96, 255}));
}

TEST(LayerPicture, TellsItsValues) {
  Layers layers;
  layers.depth = row(1, {0.4f, 0.6f, kNothing});
  layers.object = row(4, {0.1f, 0.2f, 3, 1});
  const LayerPicture depth = picture_of_layer(layers, View::depth, {});
  EXPECT_EQ(layer_text(depth, 0, 0), "depth 0.4000 m (0.400 white, 0.600 dark)");
  EXPECT_EQ(layer_text(depth, 2, 0), "depth: no object here");
  EXPECT_EQ(layer_text(picture_of_layer(layers, View::object, {}), 0, 0), "object 0.100 0.200 3.000, covers 1.000");
}

/// Opacity of the tint, a number a pixel.
std::vector<int> alpha(const std::vector<unsigned char>& rgba) {
  std::vector<int> result;
  for (std::size_t i = 3; i < rgba.size(); i += 4) result.push_back(rgba[i]);
  return result;
}

TEST(MaskTint, ShowsWhatIsOn) {
  const FrameMasks masks{{255, 0, 100}, {0, 200, 0}};
  EXPECT_EQ(alpha(mask_tint(masks, true, true)), (std::vector<int>{127, 100, 50}));
  EXPECT_EQ(alpha(mask_tint(masks, true, false)), (std::vector<int>{127, 0, 50}));
  EXPECT_EQ(alpha(mask_tint(masks, false, true)), (std::vector<int>{0, 100, 0}));
  const auto both = mask_tint(masks, true, true);
  EXPECT_GT(both[0], both[2]) << "the object is orange";
  EXPECT_LT(both[4], both[6]) << "the shadow is blue";
}

TEST(Masks, AreCoverageAndLightTaken) {
  Layers layers;
  layers.object = Image(2, 1, 4), layers.shadow = Image(2, 1, 3);
  layers.object.pixel(1, 0)[3] = 1;
  for (const int c : {0, 1, 2}) layers.shadow.pixel(0, 0)[c] = 0.25f, layers.shadow.pixel(1, 0)[c] = 1.5f;
  const FrameMasks masks = masks_of(layers);
  EXPECT_EQ(masks.object, (std::vector<unsigned char>{0, 255}));
  EXPECT_EQ(masks.shadow, (std::vector<unsigned char>{191, 0})) << "a bounce takes nothing";
}

}  // namespace
}  // namespace catchlight::tests
