// Picks the pixels of a frame that say where a tag is.
#pragma once

#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/track.hpp"
#include "tracking/refinement/ideal_pixels.hpp"
#include "tracking/refinement/response_table.hpp"
#include "tracking/refinement/tag_pattern.hpp"
#include "tracking/refinement/tag_view.hpp"

namespace catchlight::tracking {

struct TagPixel {
  IdealPixel place;
  double code;  ///< normalised, see ResponseTable
};

/// What is looked at: single pixels, or the mean light of blocks of them for a first, coarse look.
struct PixelChoice {
  Covariance2 blur_px2;
  double slack_px = 0;  ///< how far the pose may be off: known cells have to reach that much further
  int block_px = 1;
  std::size_t most = 4000;
};

/// Pixels near the print's edges, and a few of its plateaus. `view` is where the tag is thought to be. Chosen evenly and always
/// alike where there are more than asked for.
std::vector<TagPixel> choose_pixels(const LumaView& luma, const CameraModel& camera, IdealPixels& ideal_pixels,
                                    const ResponseTable& response, const TagPattern& pattern, const TagView& view,
                                    const PixelChoice& choice);

}  // namespace catchlight::tracking
