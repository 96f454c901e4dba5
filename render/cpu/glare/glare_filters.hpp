// What the steps of glare share: blurs, passes of streaks, and looking up what lies between texels.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/cpu/glare/glare_picture.hpp"
#include "render/glare/glare_plan.hpp"

namespace catchlight::render {

inline Span columns_of(const PixelRect& rect) {
  return {rect.x, rect.x + rect.width};
}

/// Makes a picture of another's size, or clears one that is.
void fit(GlarePicture& picture, const GlarePicture& like);

/// Adds `weight` times the blurred picture, black beyond its edges, over texels of `to`; both and `scratch` are of one size.
/// `taps` are the weights at distance 0, 1, 2 ...
void add_blurred(const GlarePicture& from, const std::vector<double>& taps, double weight, GlarePicture& scratch,
                 GlarePicture& to, const PixelRect& reached);

/// Adds a pass of a streak (shaders/glare_streak.frag) over texels of `to`.
void add_streak_pass(const GlarePicture& from, const StreakSamples& pass, GlarePicture& to, const PixelRect& reached);

/// Two texels, and how far from the first to the second one a place lies along an axis.
struct LinearSamples {
  int first, second;
  float share;
};
/// Where the middles of `count` pixels lie on as many texels as cover them all; beyond the outermost middles the edge goes on.
std::vector<LinearSamples> linear_samples(int count, int texels);

/// Adds `weight` times a row between the rows of a picture, at each of `across`.
void add_between(const GlarePicture& from, const LinearSamples& down, const std::vector<LinearSamples>& across, float weight,
                 Float4* to);

}  // namespace catchlight::render
