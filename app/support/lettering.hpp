// The one face of all lettering: on tag prints (PDF, SVG, PNG) and in the pictures that we draw. Lines of a pen, no outlines.
#pragma once

#include <glm/glm.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace catchlight::app {

/// A line of the pen, from point to point.
using PenLine = std::vector<glm::dvec2>;

/// The lines that write `text` from (0, 0) on its baseline, x right and y down, in heights of a capital. ASCII; what else there
/// is shows as a box.
std::vector<PenLine> lettering(std::string_view text);

/// How far the text reaches to the right, in the same unit.
double lettering_width(std::string_view text);

/// What letters like g reach below the baseline.
constexpr double kLetteringDescent = 2.0 / 7;

/// Writes with capitals of `capital_px`, antialiased.
void write_text(cv::Mat& picture, const std::string& text, const glm::dvec2& baseline_px, double capital_px,
                const cv::Scalar& color, int thickness_px = 1);

}  // namespace catchlight::app
