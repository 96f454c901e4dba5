// The white balance by a click on something white or grey.
#pragma once

#include <glm/glm.hpp>

#include "catchlight/plate.hpp"

namespace catchlight::app {

/// The mean light of a plate's few pixels. Throws Error where one of them is clipped, for that hides its colour.
glm::dvec3 mean_light(const Plate& plate, const PlateColor& color);

/// exposure.white_balance that gives white paper in the virtual layer the colour of `grey` and leaves its luminance: (grey /
/// Y(grey)) / (paper / Y(paper)), rounded to thousandths. `grey`: light of something white or grey in the footage; `paper`: light
/// of the layer's paper, as it is without a balance by hand; `black`: what the lens scatters over both. Throws Error where `grey`
/// is too dark to tell a colour, or so coloured that no balance makes it grey.
glm::dvec3 white_balance_for(const glm::dvec3& grey, const glm::dvec3& paper, const glm::dvec3& black);

}  // namespace catchlight::app
