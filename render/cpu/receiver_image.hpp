// The receiver's shadow as the camera sees it.
#pragma once

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/cpu/pixel_rays.hpp"
#include "render/cpu/receiver_shadow.hpp"
#include "render/frame_plan.hpp"

namespace catchlight::render {

/// Draws the ratio of shadowed to unshadowed light into an image of the plan's rectangle with four channels; 1 where there is no
/// shadow. Where it changes slowly it is interpolated. Gives the pixels of the image beyond which it does so, and no blur shows.
PixelRect draw_receiver(const FrameView& view, const FramePlan& plan, const PixelRays& pixel_rays, const ReceiverShadow& shadow,
                        Image& ratio);

}  // namespace catchlight::render
