// A tag's print as a blurring lens sees it: exact, for the whole pattern and not only its outer edges.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "catchlight/track.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::tracking {

/// Share of white seen at one point, and how it changes. Coordinates are cells: (0, 0) the top left corner of the detected
/// square, u to the right and v down as the tag is read.
struct PatternSample {
  bool known = false;  ///< false: unknown cells reach into it
  bool edge = false;   ///< false: a plateau, all derivatives 0
  double white = 0;
  glm::dvec2 gradient{0.0};       ///< per cell
  double uu = 0, uv = 0, vv = 0;  ///< second derivatives, per cell²
};

class TagPattern {
 public:
  explicit TagPattern(const TagLayout& layout);

  int cells_across() const { return cells_across_; }
  int margin() const { return margin_; }

  /// White share of a cell of the print, 0 or 1; negative: unknown.
  float white(int column, int row) const;

  enum class Neighbourhood { unknown, plateau, edge };

  /// What lies within reach of a point.
  Neighbourhood around(const glm::dvec2& cell, const glm::dvec2& reach_cells) const;

  /// The print convolved with a Gaussian of covariance `blur_cells2`. Every corner where four cells meet adds its
  /// mixed difference times a bivariate normal distribution, every straight edge a univariate one; nothing beyond 3.5 standard
  /// deviations counts. Paper is white beyond the print.
  PatternSample sample(const glm::dvec2& cell, const Covariance2& blur_cells2) const;

 private:
  PatternSample sample_near_one_corner(const glm::dvec2& cell, const Covariance2& blur_cells2, const glm::dvec2& sigma) const;
  PatternSample sample_near_many(const glm::dvec2& cell, const Covariance2& blur_cells2) const;
  double clamped(int column, int row) const;

  int cells_across_, margin_, side_;
  std::vector<float> white_;
};

}  // namespace catchlight::tracking
