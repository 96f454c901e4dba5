// Pictures of flat boards through a known lens, sharing no code with what finds them or calibrates: rays meet the board's plane,
// the lens is inverted by fixed-point iteration, tags come from the library's own drawing.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::tests {

/// Linear light of a point of the board's plane, metres from the board's middle.
using BoardLight = std::function<double(const glm::dvec2& point_m)>;

/// Columns and rows of corners where four squares meet; white margin of one square.
BoardLight checkerboard(int inner_columns, int inner_rows, double square_m);

/// tag36h11, ids row by row from the top left; on white paper that ends one cell beyond the outermost tags.
BoardLight tag_board(int columns, int rows, double size_m, double spacing_m, int first_id);

/// A sheet of paper, printed in black.
BoardLight printed(const cv::Mat1b& picture, double pixels_per_m);

/// 8-bit sRGB codes with noise of one code; blurred by 0.7 px. Only the first four coefficients of the lens.
cv::Mat1b board_picture(const CameraModel& camera, const RigidTransform& camera_from_board, const BoardLight& light,
                        unsigned seed);

}  // namespace catchlight::tests
