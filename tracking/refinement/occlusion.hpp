// Finds the cells of a tag that something else covers: a finger, the object itself, a highlight.
#pragma once

#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "tracking/refinement/direct_model.hpp"

namespace catchlight::tracking {

struct Uncovered {
  std::vector<TagPart> parts;
  std::vector<TagLight> light;  ///< of those parts
  double kept_share = 1;        ///< of the pixels
};

/// A robust loss alone lets the covered half of an edge lean on the fit. What covers a tag is larger than a pixel: so cells most
/// of whose pixels do not fit are left out, with half a cell around them, into which the cover's edge reaches. Empty where
/// nothing is covered, or too little would be left.
std::optional<Uncovered> leave_out_covered(const CameraModel& camera, const DirectModel& model, const DirectParameters& at,
                                           const std::vector<Residual>& residuals, const RobustLoss& loss);

/// Whether cells are inverted both ways, white where black should be and black where white should be: then it is another id's
/// print, or this one turned, whose border alone fits. Covers are one or the other.
bool shows_another_print(const CameraModel& camera, const ResponseTable& response, const std::vector<TagPart>& parts,
                         const DirectParameters& at);

}  // namespace catchlight::tracking
