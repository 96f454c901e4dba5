#include "app/window/playing/layer_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "catchlight/color.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr std::array<unsigned char, 3> kObjectTint{255, 150, 40}, kShadowTint{70, 130, 255};
constexpr float kMaxTint = 0.5f;
constexpr float kFarthestCode = 40;  // dark, but told apart from where there is nothing

unsigned char byte(double code) {
  return static_cast<unsigned char>(std::clamp(std::lround(code), 0L, 255L));
}

/// A picture whose pixels are made of the image's, a channel each.
template <class Code>
RgbPicture made_of(const Image& image, const Code& code) {
  RgbPicture picture{image.width, image.height, {}};
  picture.rgb.reserve(static_cast<std::size_t>(3) * image.width * image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) picture.rgb.push_back(byte(code(image.pixel(x, y), c)));
  return picture;
}

const Image& values_of(const Layers& layers, View view) {
  switch (view) {
    case View::reflection:
      return layers.reflection;
    case View::shadow:
      return layers.shadow;
    case View::glare:
      return layers.glare;
    case View::normals:
      return layers.normal;
    case View::depth:
      return layers.depth;
    default:
      return layers.object;
  }
}

RgbPicture picture_of(const Image& values, View view, const PlateColor& color) {
  if (view == View::shadow) return ratio_picture(values);
  if (view == View::normals) return normals_picture(values);
  if (view == View::depth) return depth_picture(values);
  return light_picture(values, color);
}

}  // namespace

LayerPicture picture_of_layer(const Layers& layers, View view, const PlateColor& color) {
  const Image& values = values_of(layers, view);
  return {view, values, picture_of(values, view, color), 0};
}

RgbPicture light_picture(const Image& light, const PlateColor& color) {
  return made_of(light,
                 [&](const float* pixel, int c) { return pixel[c] == 0 ? 0.0 : 255 * code_from_linear(color, pixel[c], c); });
}

RgbPicture normals_picture(const Image& normals) {
  return made_of(normals, [](const float* n, int c) {
    const bool is_none = n[0] == 0 && n[1] == 0 && n[2] == 0;
    return is_none ? 0.0 : 127.5 * (1 + n[c]);
  });
}

DepthRange depth_range(const Image& depth_m) {
  DepthRange range{std::numeric_limits<float>::max(), 0};
  for (const float value : depth_m.data)
    if (std::isfinite(value)) range.near_m = std::min(range.near_m, value), range.far_m = std::max(range.far_m, value);
  return range.far_m > 0 ? range : DepthRange{};
}

RgbPicture depth_picture(const Image& depth_m) {
  const DepthRange range = depth_range(depth_m);
  const float length_m = std::max(range.far_m - range.near_m, 1e-6f);
  return made_of(depth_m, [&](const float* pixel, int) {
    return std::isfinite(*pixel) ? 255 - (255 - kFarthestCode) * (*pixel - range.near_m) / length_m : 0.0f;
  });
}

RgbPicture ratio_picture(const Image& ratio) {
  return made_of(ratio, [](const float* pixel, int c) { return kUnshadowedCode * pixel[c]; });
}

FrameMasks masks_of(const Layers& layers) {
  FrameMasks masks;
  for (std::size_t i = 0; i + 3 < layers.object.data.size(); i += 4)
    masks.object.push_back(byte(255 * layers.object.data[i + 3]));
  for (std::size_t i = 0; i + 2 < layers.shadow.data.size(); i += 3) {
    const glm::dvec3 ratio(layers.shadow.data[i], layers.shadow.data[i + 1], layers.shadow.data[i + 2]);
    masks.shadow.push_back(byte(255 * (1 - glm::dot(kLuminanceWeights, ratio))));
  }
  return masks;
}

std::vector<unsigned char> mask_tint(const FrameMasks& masks, bool has_object, bool has_shadow) {
  std::vector<unsigned char> rgba(4 * masks.object.size());
  for (std::size_t i = 0; i < masks.object.size(); ++i) {
    const float object = has_object ? kMaxTint * static_cast<float>(masks.object[i]) : 0,
                shadow = has_shadow ? kMaxTint * static_cast<float>(masks.shadow[i]) : 0, most = std::max(object, shadow);
    std::ranges::copy(object >= shadow ? kObjectTint : kShadowTint, rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    rgba[4 * i + 3] = static_cast<unsigned char>(most);
  }
  return rgba;
}

std::string layer_text(const LayerPicture& layer, int x, int y) {
  const float* value = layer.values.pixel(x, y);
  const auto figures = [&](int digits) {
    return fixed_text(value[0], digits) + " " + fixed_text(value[1], digits) + " " + fixed_text(value[2], digits);
  };
  const std::string name = layer.view == View::light ? light_name(layer.light) : name_of(layer.view);
  if (layer.view == View::depth) {
    const DepthRange range = depth_range(layer.values);
    const std::string ends = " (" + fixed_text(range.near_m, 3) + " white, " + fixed_text(range.far_m, 3) + " dark)";
    return std::isfinite(*value) ? name + " " + fixed_text(*value, 4) + " m" + ends : name + ": no object here";
  }
  if (layer.view == View::shadow) return name + " ratio " + figures(3);
  if (layer.view == View::object) return name + " " + figures(3) + ", covers " + fixed_text(value[3], 3);
  return name + " " + figures(3);
}

}  // namespace catchlight::app
