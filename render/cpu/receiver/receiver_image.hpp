// The receiver's shadow as the camera sees it.
#pragma once

#include <vector>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/cpu/receiver/receiver_shadow.hpp"
#include "render/cpu/surface/pixel_rays.hpp"
#include "render/frame_plan.hpp"

namespace catchlight::render {

/// Rectangles of an image's pixels, a band of rows each, that together hold where a shadow's edges are sharp.
using SharpBands = std::vector<PixelRect>;

/// Draws the ratio of shadowed to unshadowed light into an image of the plan's rectangle with four channels; 1 where there is no
/// shadow. Where it changes slowly it is interpolated, and no blur shows: gives the pixels of the image where it does not.
SharpBands draw_receiver(const FrameView& view, const FramePlan& plan, const PixelRays& pixel_rays, const ReceiverShadow& shadow,
                         Image& ratio);

}  // namespace catchlight::render
