// The layers for compositing packages as pictures that a person can read.
#pragma once

#include <string>

#include "app/window/playing/frame_extras.hpp"
#include "app/window/surface/rgb_picture.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {

/// A layer that is looked at: its values, and their picture.
struct LayerPicture {
  View view = View::object;
  Image values;
  RgbPicture picture;
  int light = 0;  ///< of View::light
};

/// `color`: how the footage codes light; what is light is shown by it.
LayerPicture picture_of_layer(const Layers& layers, View view, const PlateColor& color);

/// Light as the footage codes it: what is brighter than its white is cut off. The first three channels.
RgbPicture light_picture(const Image& light, const PlateColor& color);

/// Directions from -1 to 1 as colours: x red, y green, z blue. Black where there is none.
RgbPicture normals_picture(const Image& normals);

/// Nearest and farthest finite value; 0, 0 where there is none.
struct DepthRange {
  float near_m = 0, far_m = 0;
};
DepthRange depth_range(const Image& depth_m);

/// The nearest point white, the farthest dark grey; black where there is nothing.
RgbPicture depth_picture(const Image& depth_m);

/// How much of the light is left: 1 is kUnshadowedCode, what is brighter tends to white.
inline constexpr int kUnshadowedCode = 191;
RgbPicture ratio_picture(const Image& ratio);

/// What the object covers of each pixel, and how much light it takes from it: 255 is all.
struct FrameMasks {
  std::vector<unsigned char> object, shadow;
};
FrameMasks masks_of(const Layers& layers);

/// How the masks are laid over a picture: RGBA, 8 bits. The object orange, the shadow blue.
std::vector<unsigned char> mask_tint(const FrameMasks& masks, bool has_object, bool has_shadow);

/// What the layer holds at a pixel, in words.
std::string layer_text(const LayerPicture& layer, int x, int y);

}  // namespace catchlight::app
