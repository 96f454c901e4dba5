// The parts of a tag's print, and of the sheet around it, where the picture is known to be flat: what is left of them is noise.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/code_view.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"

namespace catchlight::tracking {

/// Sums over places, to take a plane off the values there.
struct PlaneSums {
  double n = 0;
  glm::dvec2 place{0.0};
  glm::dvec3 square{0.0};  ///< xx, xy, yy

  void add(const glm::dvec2& at) {
    n += 1, place += at;
    square += glm::dvec3(at.x * at.x, at.x * at.y, at.y * at.y);
  }

  /// Determinant of the places' covariance: 0 where they are on one line.
  double spread() const {
    const glm::dvec2 middle = place / n;
    const glm::dvec3 about = square / n - glm::dvec3(middle.x * middle.x, middle.x * middle.y, middle.y * middle.y);
    return about.x * about.z - about.y * about.y;
  }

  /// Inverse of the plane's normal equations, by 1, x and y.
  glm::dmat3 inverse() const {
    return glm::inverse(glm::dmat3{{n, place.x, place.y}, {place.x, square.x, square.y}, {place.y, square.y, square.z}});
  }
};

/// What is left of a sum of products of two kinds of values where the best planes are taken off both; `a` and `b` are those
/// values' own sums, alone and times x and y.
inline double left_over(double products, const glm::dvec3& a, const glm::dvec3& b, const glm::dmat3& inverse) {
  return products - glm::dot(a, inverse * b);
}

/// The blocks of a cell that no edge's light reaches, as sums over their codes: a plane is taken off them without a second look.
/// Places and codes are counted from those of the first block, so that nothing of small differences is lost. What is summed
/// alone and times x and y is a vector.
struct FlatCell {
  bool is_clipped = false, is_on_print = true;
  glm::dvec2 first_block{0.0};
  glm::dvec3 first_color{0.0};
  double first_luma = 0;
  PlaneSums pixels, blocks;
  glm::dvec3 luma{0.0};               ///< the pixels'
  double luma_square = 0;             ///< likewise
  glm::dvec3 block_luma{0.0};         ///< means of blocks
  std::array<glm::dvec3, 3> color{};  ///< RGB less luma, a channel each
  glm::dmat3 color_square{0.0};
  glm::dvec3 color_luma{0.0};
  double fine = 0, fine_count = 0;  ///< squares of luma's mixed second difference, of unit gain for white noise
};

/// A cell for each of the print, and of the sheet that may go on around it, with what of it is far enough from every edge.
std::vector<FlatCell> flat_cells(const CodeView& codes, const CameraModel& camera, const RigidTransform& camera_from_tag,
                                 const BundledTag& tag, const Covariance2& blur_px2);

}  // namespace catchlight::tracking
