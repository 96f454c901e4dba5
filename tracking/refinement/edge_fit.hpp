// Places one straight, blurred edge between two plateaus, from the values of the pixels around it.
#pragma once

#include <optional>
#include <span>

namespace catchlight::tracking {

/// One pixel near the edge. No resampling: each pixel enters once, where it is.
struct EdgePixel {
  double along;      ///< 0 at the edge's start, 1 at its end
  double across_px;  ///< signed distance from the first guess of the edge
  double value;      ///< linear light
};

struct EdgeFit {
  double shift_start_px = 0, shift_end_px = 0;  ///< how far the edge is from its guess, along +across
  double blur_px = 0;                           ///< standard deviation of the camera's blur across the edge
  double step = 0;                              ///< value far on the + side minus value far on the - side
  double noise = 0;                             ///< robust standard deviation of what the model leaves over
};

/// Least squares, robust against outliers, of
///   value = middle(along) + step(along)/2 · erf((across − shift(along)) / (√2 · blur)) + slope · brighter side's distance,
/// where shift, middle and step are linear in `along`. The slope takes up shading across the brighter side, which would
/// otherwise lean on the edge. Empty where the pixels are too few, too flat or too noisy to place an edge.
std::optional<EdgeFit> fit_edge(std::span<const EdgePixel> pixels);

}  // namespace catchlight::tracking
