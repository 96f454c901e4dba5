// Object, shadow and glare put into the plate in linear light (Debevec 1998; premultiplied over), then coded as the plate was.
#pragma once

#include <array>
#include <functional>

#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "render/cpu/plate/response_table.hpp"
#include "render/frame_view.hpp"

namespace catchlight::render {

/// Gives the glare of `count` pixels of the frame from (x, y) on to the right: RGB, exposed linear.
using GlareRow = std::function<void(int x, int y, int count, float* rgb)>;

/// Gives the ratio of shadowed to unshadowed light in the same way, a plane a channel: red, green, blue. False where it is 1.
using ShadowRow = std::function<bool(int x, int y, int count, const std::array<float*, 3>& ratio)>;

/// What is put into the plate.
struct VirtualImages {
  const Image* object = nullptr;      ///< RGBA, premultiplied exposed linear: the frame's pixels of `object_rect`; null: none
  const Image* reflection = nullptr;  ///< the mirrored part of it, in the same way; read only for layers
  PixelRect object_rect;
  ShadowRow shadow = {};     ///< empty: none
  GlareRow glare = {};       ///< empty: none drawn
  double passed_at_tag = 0;  ///< share of light that vignetting leaves at the tag, where exposure is matched; 0: unknown
};

/// Composites the pixels of result.rect, which the plate holds, into result.rgba, and into result.layers where it has any.
/// `as_light`: linear light instead of codes, for the tone curve to go on from. `take`, if there is one, takes the pixels instead
/// of result.rgba; there may be no layers then. Throws Error if the plate is not of its rectangle's size.
void composite_plate(const FrameView& view, const Plate& plate, const ResponseTable& response,
                     const VirtualImages& virtual_images, bool as_light, const CompositeSink& take, Composite& result);

/// Throws Error if the plate is not of its rectangle's size.
void check_plate(const Plate& plate);

}  // namespace catchlight::render
