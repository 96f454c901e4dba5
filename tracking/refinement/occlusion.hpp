// Finds the cells of a tag that something else occludes: a finger, the object itself, a highlight.
#pragma once

#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "tracking/refinement/direct_model.hpp"

namespace catchlight::tracking {

/// What is left of the model where the occluded cells are taken out.
struct Unoccluded {
  std::vector<TagPart> parts;
  std::vector<TagLight> light;  ///< one for each part
  double kept_share = 1;        ///< share of the pixels
};

/// A robust loss alone lets the occluded half of an edge lean on the fit. What occludes a tag is larger than a pixel: so cells
/// most of whose pixels do not fit are left out, with half a cell around them, into which the occluder's edge reaches. Empty
/// where nothing is occluded, or too little would be left.
std::optional<Unoccluded> leave_out_occluded(const CameraModel& camera, const DirectModel& model, const DirectParameters& at,
                                             const std::vector<Residual>& residuals, const RobustLoss& loss);

/// Whether cells are inverted both ways, white where black should be and black where white should be: then it is another id's
/// print, or this one turned, whose border alone fits. An occluder is lighter or darker, not both.
bool shows_another_print(const CameraModel& camera, const ResponseTable& response, const std::vector<TagPart>& parts,
                         const DirectParameters& at);

}  // namespace catchlight::tracking
