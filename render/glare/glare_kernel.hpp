// The kernel that the glare passes stand for, in closed form and at any resolution: what a convolution needs that is to give the
// same picture. No GL needed.
#pragma once

#include "catchlight/image.hpp"
#include "render/glare/glare_plan.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

/// Light that a pixel of 1 adds to the pixels around it, strengths included; its centre is pixel (width / 2, height / 2), rounded
/// down. `frame_height_px`: rows of the picture to be convolved; below 120 a streak is narrower than the pixels can show. Bloom:
/// the sum of w / (2 pi s^2) exp(-r^2 / 2 s^2) over bloom_gaussians(). A streak along u, across v: l exp(-l u) for u > 0
/// convolved with the Gaussian of settings.streak_width in both, where l = -ln a per pixel; the strength is shared by the
/// directions.
Image glare_kernel(const GlareSettings& settings, double frame_height_px, int width, int height);

/// A picture on the glare grid (with margins) as the composite reads it: a cubic B-spline, at the frame's pixels.
Image at_frame_pixels(const Image& grid_picture, const GlareGrid& grid, int frame_width, int frame_height);

}  // namespace catchlight::render
